// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the contents of an interchange scene (.mvs) without loading it, to estimate memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "scene/scene.h"

namespace axial::io {

// The numbers of items in a scene file.
struct MvsCounts {
  std::uint64_t file_bytes = 0;
  std::uint64_t cameras = 0, poses = 0, images = 0;  // images: calibrated or not
  std::uint64_t name_bytes = 0;                      // of the names of all images and masks
  std::uint64_t view_scores = 0;                     // of all images
  std::uint64_t points = 0;                          // sparse points
  std::uint64_t observations = 0;                    // views of all points
  std::uint64_t pairs = 0;                // ordered pairs of two views of one point, of all points
  std::uint64_t view_list_bytes = 0;      // heap memory of the points' lists of views
  std::uint64_t normals = 0, colors = 0;  // each 0, or one per point

  // Sets view_scores to `number` and changes `file_bytes` accordingly.
  void set_view_scores(std::uint64_t number);

  // Upper bound of the memory [bytes] of the Scene that read_mvs() makes from this file.
  std::uint64_t scene_bytes() const;
  // Upper bounds of the memory [bytes] that read_mvs and write_mvs need while they work.
  // reading_bytes() includes the scene that read_mvs returns. writing_bytes() does not include the
  // scene that write_mvs writes.
  std::uint64_t reading_bytes() const;
  std::uint64_t writing_bytes() const;
};

// Counts the contents of the scene file `path`. The file is read through a buffer of at most one
// MiB. Returns nothing for a file of version 0, a file that cannot be read and a malformed file. In
// the last two cases read_mvs() reports the reason.
std::optional<MvsCounts> count_mvs(const std::filesystem::path& path);

// Returns the counts of the file that write_mvs would make of `scene`. `cameras`, `poses`,
// `name_bytes` and `file_bytes` are upper bounds. `pairs` is not counted and stays 0.
MvsCounts count_scene(const Scene& scene);

}  // namespace axial::io
