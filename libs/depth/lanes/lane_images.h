// SPDX-License-Identifier: GPL-3.0-or-later
// The places of source images in the tables of a scene, with one image per SIMD lane.
#pragma once

#include "depth/lanes/pack.h"
#include "depth/lanes/scorer.h"

namespace axial::depth::lanes {

// The source image of each lane.
template <class Abi>
struct LaneImages {
  // Index of the image's first word in SceneTables::words, and of its first depth in
  // SceneTables::depths.
  typename Pack<Abi>::Ints begin;
  Pack<Abi> width, height;  // [px]
};

// Returns the image of one view for each lane. `view`: one index per lane, of the lane's view in
// `tables`. Precondition: the array is aligned to the size of the register.
template <class Abi>
LaneImages<Abi> lane_images(const SceneTables& tables, const std::int32_t* view) {
  using Ints = typename Pack<Abi>::Ints;
  const Lookup<Abi> of(view);
  return {Ints([&](auto k) { return tables.image_begin[static_cast<std::size_t>(view[k])]; }),
          of(tables.width.data()), of(tables.height.data())};
}

}  // namespace axial::depth::lanes
