// SPDX-License-Identifier: GPL-3.0-or-later
// The files in which a run by tiles keeps its intermediate results.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cloud/tiles.h"
#include "io/artifacts/artifact.h"
#include "mesh/merge_points.h"
#include "mesh/tile_mesh.h"

namespace axial::mesh {

// The files are in a subfolder of `folder` with the name `origin`, 32 hex digits, which identify
// all that decides on the files. So runs with other input or other options do not meet these files.
class TileFiles {
 public:
  TileFiles(std::filesystem::path folder, std::string origin)
      : parent_(std::move(folder)), folder_(parent_ / origin), made_from_(std::move(origin)) {}

  // Creates both folders. Error if this is not possible.
  void make_folders() const;
  // Whether `folder` has files of runs with another origin.
  bool has_others() const;

  // The points of tile `tile` (from 0), a PLY file.
  std::filesystem::path cloud(std::size_t tile) const;

  // Write a file through a temporary one. Error if it cannot be written.
  void write(const std::vector<cloud::Tile>& tiles) const;
  void write(std::size_t tile, const MergedPoints& points) const;
  void write(std::size_t tile, const TileMesh& mesh) const;

  // Read a file. Empty if it is missing or damaged.
  std::optional<std::vector<cloud::Tile>> tiles() const;
  std::optional<MergedPoints> points(std::size_t tile) const;
  std::optional<TileMesh> mesh(std::size_t tile) const;

  // Removes the subfolders of all origins, and `folder` if it is empty then. Failures are ignored.
  void remove() const;

 private:
  std::filesystem::path file(const char* content, std::size_t tile, const char* extension) const;
  std::string of_tile(std::size_t tile) const;  // what a file of the tile is made from
  // The numbers in the kinds of these files are the versions of the formats and of the methods.
  io::Artifact boxes() const;
  io::Artifact points_file(std::size_t tile) const;
  io::Artifact mesh_file(std::size_t tile) const;

  std::filesystem::path parent_, folder_;
  std::string made_from_;
};

}  // namespace axial::mesh
