// SPDX-License-Identifier: GPL-3.0-or-later
// The source image of each lane: the index of its first word in SceneTables::words, and its size.
#pragma once

#include "depth/lanes/pack.h"
#include "depth/lanes/scorer.h"

namespace axial::depth::lanes {

template <class Abi>
struct LaneImages {
  typename Pack<Abi>::Ints begin;
  Pack<Abi> width, height;
};

// Returns the images of one view per lane. `view`: the indices of these views, aligned to the
// size of the register.
template <class Abi>
LaneImages<Abi> lane_images(const SceneTables& tables, const std::int32_t* view) {
  using Ints = typename Pack<Abi>::Ints;
  const Lookup<Abi> of(view);
  return {Ints([&](auto k) { return tables.image_begin[static_cast<std::size_t>(view[k])]; }),
          of(tables.width.data()), of(tables.height.data())};
}

}  // namespace axial::depth::lanes
