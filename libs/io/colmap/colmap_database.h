// SPDX-License-Identifier: GPL-3.0-or-later
// Reads features and verified matches from COLMAP's database.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/colmap/colmap.h"

namespace axial::io {

// A photograph in which COLMAP looked for features, whether it has a pose or not.
struct DatabaseImage {
  std::uint32_t id = 0;
  std::uint32_t camera = 0;  // id of its camera
  std::string name;          // path relative to the image folder
  // All features with their sizes, in COLMAP's order. The image points of a model of the same
  // photograph (ColmapImage::points) have the same order. Features belong to no point.
  std::vector<ColmapPoint2D> features;
};

// The verified matches of two photographs: those that agree with one two-view geometry.
struct DatabasePair {
  std::uint32_t first = 0, second = 0;  // ids of images; `first` is the smaller one
  // Indices into the features of the first and of the second image.
  std::vector<std::array<std::uint32_t, 2>> matches;
};

// The contents of a database, each list in the order of the ids. Pairs without verified matches are
// left out, and so are pairs that COLMAP takes for a watermark.
struct ColmapDatabase {
  std::vector<ColmapCamera> cameras;
  std::vector<DatabaseImage> images;
  std::vector<DatabasePair> pairs;
};

// Reads a database of COLMAP 3.8 to 4.1. The file and its folder are not changed.
//
// Error of one line that names the file for a file that does not exist or is not a database of
// SQLite, a table or a column that is missing, a camera that check_colmap_camera() refuses, an
// image without a camera, two images with the same name, coordinates that are not finite, data of
// another length than rows and columns say, and matches with images or features that do not exist.
ColmapDatabase read_colmap_database(const std::filesystem::path& file);

}  // namespace axial::io
