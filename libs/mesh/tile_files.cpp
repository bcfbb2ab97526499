// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/tile_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "base/atomic_file.h"
#include "io/artifacts/array_file.h"

namespace axial::mesh {
namespace {

// The subfolders of `folder` that have the name of an origin.
std::vector<std::filesystem::path> folders_of_origins(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.size() == 32 && name.find_first_not_of("0123456789abcdef") == std::string::npos)
      found.push_back(entry.path());
  }
  return found;
}

}  // namespace

std::filesystem::path TileFiles::file(const char* content, std::size_t tile,
                                      const char* extension) const {
  return folder_ / fmt::format("{}{}.{}", content, tile + 1, extension);
}

std::string TileFiles::of_tile(std::size_t tile) const {
  return fmt::format("{} tile {}", made_from_, tile);
}

std::filesystem::path TileFiles::cloud(std::size_t tile) const {
  return file("cloud", tile, "ply");
}

io::Artifact TileFiles::boxes() const {
  return {folder_ / "tiles.bin", made_from_, "tiles 1"};
}

io::Artifact TileFiles::points_file(std::size_t tile) const {
  return {file("points", tile, "bin"), of_tile(tile), "merged points 1"};
}

io::Artifact TileFiles::mesh_file(std::size_t tile) const {
  return {file("mesh", tile, "bin"), of_tile(tile), "mesh of a tile 1"};
}

void TileFiles::write(const std::vector<cloud::Tile>& tiles) const {
  std::vector<double> numbers;
  for (const cloud::Tile& tile : tiles)
    for (const double* values : {tile.rotation.data(), tile.low.data(), tile.high.data()})
      numbers.insert(numbers.end(), values, values + (values == tile.rotation.data() ? 9 : 3));
  io::write_arrays(boxes(), numbers);
}

std::optional<std::vector<cloud::Tile>> TileFiles::tiles() const {
  std::vector<double> numbers;
  if (!io::read_arrays(boxes(), numbers)) return {};
  std::vector<cloud::Tile> tiles(numbers.size() / 15);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const double* values = numbers.data() + 15 * i;
    std::copy_n(values, 9, tiles[i].rotation.data());
    std::copy_n(values + 9, 3, tiles[i].low.data());
    std::copy_n(values + 12, 3, tiles[i].high.data());
  }
  return tiles;
}

void TileFiles::write(std::size_t tile, const MergedPoints& points) const {
  io::write_arrays(points_file(tile), points.positions, points.pixel_widths, points.view_begin,
                   points.view_images, points.view_weights);
}

std::optional<MergedPoints> TileFiles::points(std::size_t tile) const {
  MergedPoints points;
  if (!io::read_arrays(points_file(tile), points.positions, points.pixel_widths, points.view_begin,
                       points.view_images, points.view_weights))
    return {};
  points.count = points.size();
  return points;
}

void TileFiles::write(std::size_t tile, const TileMesh& mesh) const {
  io::write_arrays(mesh_file(tile), mesh.mesh.vertices, mesh.mesh.faces, mesh.seams);
}

std::optional<TileMesh> TileFiles::mesh(std::size_t tile) const {
  TileMesh mesh;
  if (!io::read_arrays(mesh_file(tile), mesh.mesh.vertices, mesh.mesh.faces, mesh.seams)) return {};
  return mesh;
}

void TileFiles::make_folders() const {
  make_folder(folder_);
}

bool TileFiles::has_others() const {
  const std::vector<std::filesystem::path> folders = folders_of_origins(parent_);
  return std::ranges::any_of(folders, [&](const auto& path) { return path != folder_; });
}

void TileFiles::remove() const {
  std::error_code ignored;
  for (const std::filesystem::path& path : folders_of_origins(parent_))
    std::filesystem::remove_all(path, ignored);
  std::filesystem::remove(parent_, ignored);
}

}  // namespace axial::mesh
