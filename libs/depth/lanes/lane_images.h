// SPDX-License-Identifier: GPL-3.0-or-later
// The source image of every lane: where it begins in the run of all images, and its size.
#pragma once

#include "depth/lanes/pack.h"
#include "depth/lanes/scorer.h"

namespace axial::depth::lanes {

template <class Abi>
struct LaneImages {
  typename Pack<Abi>::Ints begin;
  Pack<Abi> width, height;
};

// Those of the views whose indices begin at `view`.
template <class Abi>
LaneImages<Abi> lane_images(const SceneTables& tables, const std::int32_t* view) {
  using Ints = typename Pack<Abi>::Ints;
  const Lookup<Abi> of(view);
  return {Ints([&](auto k) { return tables.image_begin[static_cast<std::size_t>(view[k])]; }),
          of(tables.width.data()), of(tables.height.data())};
}

}  // namespace axial::depth::lanes
