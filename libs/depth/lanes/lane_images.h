// SPDX-License-Identifier: GPL-3.0-or-later
// The source image of each lane: the index of the image's first word in SceneTables::words, and the
// size of the image [px].
#pragma once

#include "depth/lanes/pack.h"
#include "depth/lanes/scorer.h"

namespace axial::depth::lanes {

template <class Abi>
struct LaneImages {
  typename Pack<Abi>::Ints begin;
  Pack<Abi> width, height;
};

// Returns the image of one view for each lane. `view`: the index of each lane's view. The array is
// aligned to the size of the register.
template <class Abi>
LaneImages<Abi> lane_images(const SceneTables& tables, const std::int32_t* view) {
  using Ints = typename Pack<Abi>::Ints;
  const Lookup<Abi> of(view);
  return {Ints([&](auto k) { return tables.image_begin[static_cast<std::size_t>(view[k])]; }),
          of(tables.width.data()), of(tables.height.data())};
}

}  // namespace axial::depth::lanes
