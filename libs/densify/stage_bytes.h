// SPDX-License-Identifier: GPL-3.0-or-later
// The memory of the stages for one project. The formulas are those of the stages: each stands
// beside the memory that it counts.
#pragma once

#include <cstddef>
#include <cstdint>

#include "densify/project.h"

namespace axial::densify {

// Numbers of images. `references` get depth maps. The other numbers are the largest numbers of
// images that a stage needs for one of them, including the image itself.
struct ListLengths {
  std::size_t references = 0;
  std::size_t matched = 0;   // and its source views
  std::size_t adjusted = 0;  // and the neighbours of the adjust filter; 0: no such filter
  std::size_t fused = 0;     // and its neighbours that have maps
};

ListLengths longest_lists(const Project& project, const Settings& settings);

// Memory [bytes] of the large data, for the largest image.
struct StageBytes {
  std::uint64_t scene = 0;        // that is allocated already
  std::uint64_t write_scene = 0;  // besides `scene`, while it is written
  std::uint64_t decode = 0;       // while an image is read, without the result
  std::uint64_t image = 0;        // WorkImage
  std::uint64_t map = 0;          // DepthMap: depth, normal, confidence
  std::uint64_t depths = 0;       // of a DepthMap, the depths alone
  std::uint64_t read_map = 0;     // while a map is read or written, without the map
  std::uint64_t match = 0;        // matching, with the results
  std::uint64_t adjust = 0;
  std::uint64_t fused = 0;     // of a map in fusion
  std::uint64_t taken = 0;     // fusion's bits of all views
  std::uint64_t exported = 0;  // while an image is resampled, without cached images
};

StageBytes bytes_of_stages(const Project& project, const Settings& settings,
                           const ListLengths& lists);

}  // namespace axial::densify
