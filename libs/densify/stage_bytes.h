// SPDX-License-Identifier: GPL-3.0-or-later
// The memory that the stages of densify() need for one project. Each formula is defined in the
// source file of its stage, beside the code that allocates the memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "densify/project.h"

namespace axial::densify {

// Numbers of images. `references`: the number of images that get depth maps. Each of the next three
// is the largest number of images that a stage needs for one reference, including the reference.
struct ListLengths {
  std::size_t references = 0;
  std::size_t matched = 0;   // the reference and its source views
  std::size_t adjusted = 0;  // the reference and its neighbours in the adjust filter; 0: no filter
  std::size_t fused = 0;     // the reference and its neighbours in fusion
  // The views whose pixels fusion marks as used: all references, or those that a tile needs
  // (most_views_of_a_tile() in fusion_tiles.h).
  std::size_t marked = 0;
};

// Returns the numbers for the images and filters of a run. Precondition: views are selected, and
// there is at least one reference (load_project).
ListLengths longest_lists(const Project& project, const Settings& settings);

// Memory [bytes] of the large data. If images differ in size, each number is for the largest.
struct StageBytes {
  std::uint64_t scene = 0;        // of the loaded scene: the memory that is allocated already
  std::uint64_t write_scene = 0;  // while the scene is written, in addition to `scene`
  std::uint64_t decode = 0;       // while an image is read, in addition to `image`
  std::uint64_t image = 0;        // one survey::Pixels (image_store.h)
  std::uint64_t map = 0;          // one DepthMap: depth, normal, confidence
  std::uint64_t depths = 0;       // the depths of a DepthMap alone
  std::uint64_t read_map = 0;     // while a map is read or written, in addition to `map`
  std::uint64_t match = 0;        // matching of one reference, with the resulting map
  std::uint64_t adjust = 0;       // the adjust filter of one reference; 0: no filter
  std::uint64_t fused = 0;        // one map in fusion, with its image if the cloud has colours
  std::uint64_t taken = 0;        // fusion: one bit per pixel of ListLengths::marked views
  std::uint64_t exported = 0;     // pinhole export: while one image is resampled; 0: no export
};

// Returns the memory of each stage. `lists`: the result of longest_lists(). StageBytes::scene is
// the memory that the process has allocated at the time of the call.
StageBytes bytes_of_stages(const Project& project, const Settings& settings,
                           const ListLengths& lists);

}  // namespace axial::densify
