// SPDX-License-Identifier: GPL-3.0-or-later
// How much an interchange scene (.mvs) holds, before it is read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "scene/scene.h"

namespace axial::io {

struct MvsCounts {
  std::uint64_t file_bytes = 0;
  std::uint64_t cameras = 0, poses = 0, images = 0;
  std::uint64_t name_bytes = 0;   // of images and masks
  std::uint64_t view_scores = 0;  // of all images
  std::uint64_t points = 0;
  std::uint64_t observations = 0;     // views of all points
  std::uint64_t pairs = 0;            // ordered pairs of different views of a point
  std::uint64_t view_list_bytes = 0;  // what the heap takes for the points' lists of views
  std::uint64_t normals = 0, colors = 0;

  // Other lists of view scores, and the file's bytes with them.
  void set_view_scores(std::uint64_t number);

  // At most, of the scene that read_mvs makes, in memory.
  std::uint64_t scene_bytes() const;
  // At most, while it is read, the scene included; while it is written, besides the scene.
  std::uint64_t reading_bytes() const;
  std::uint64_t writing_bytes() const;
};

// Passes over the file, and takes a megabyte for that. Nothing for a file that cannot be read or is
// malformed: read_mvs says what is wrong with it.
std::optional<MvsCounts> count_mvs(const std::filesystem::path& path);

// The counts of the file that write_mvs makes, at most.
MvsCounts count_scene(const Scene& scene);

}  // namespace axial::io
