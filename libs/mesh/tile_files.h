// SPDX-License-Identifier: GPL-3.0-or-later
// The files in which a run by tiles keeps its intermediate results. They are read only by programs
// that were given the same input with the same options (TileRun::made_from in tiled.h).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cloud/tiles.h"
#include "mesh/merge_points.h"
#include "mesh/tile_mesh.h"

namespace axial::mesh {

class TileFiles {
 public:
  TileFiles(std::filesystem::path folder, std::string made_from)
      : folder_(std::move(folder)), made_from_(std::move(made_from)) {}

  // The points of tile `tile` (from 0), a PLY file.
  std::filesystem::path cloud(std::size_t tile) const;

  // Write a file through a temporary one. Error if it cannot be written.
  void write(const std::vector<cloud::Tile>& tiles) const;
  void write(std::size_t tile, const MergedPoints& points) const;
  void write(std::size_t tile, const TileMesh& mesh) const;

  // Read a file. Empty if it is missing or damaged, or was made from something else.
  std::optional<std::vector<cloud::Tile>> tiles() const;
  std::optional<MergedPoints> points(std::size_t tile) const;
  std::optional<TileMesh> mesh(std::size_t tile) const;

  // Removes the files of `count` tiles, and the folder if it is empty then. Failures are ignored.
  void remove(std::size_t count) const;

 private:
  std::filesystem::path file(const char* content, std::size_t tile, const char* extension) const;

  std::filesystem::path folder_;
  std::string made_from_;
};

}  // namespace axial::mesh
