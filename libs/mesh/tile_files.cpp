// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/tile_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "base/atomic_file.h"
#include "mesh/array_file.h"

namespace axial::mesh {
namespace {

// The numbers are the versions of the formats and of the methods.
constexpr const char* kBoxes = "tiles 1";
constexpr const char* kPoints = "merged points 1";
constexpr const char* kMesh = "mesh of a tile 1";

std::string of_tile(const std::string& made_from, std::size_t tile) {
  return fmt::format("{} tile {}", made_from, tile);
}

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

std::filesystem::path TileFiles::cloud(std::size_t tile) const {
  return file("cloud", tile, "ply");
}

void TileFiles::write(const std::vector<cloud::Tile>& tiles) const {
  std::vector<double> numbers;
  for (const cloud::Tile& tile : tiles)
    for (const double* values : {tile.rotation.data(), tile.low.data(), tile.high.data()})
      numbers.insert(numbers.end(), values, values + (values == tile.rotation.data() ? 9 : 3));
  write_arrays(folder_ / "tiles.bin", kBoxes, made_from_, std::array{bytes_of(numbers)});
}

std::optional<std::vector<cloud::Tile>> TileFiles::tiles() const {
  const auto arrays = read_arrays(folder_ / "tiles.bin", kBoxes, made_from_, 1);
  if (!arrays) return {};
  const std::vector<double> numbers = array_of<double>((*arrays)[0]);
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
  write_arrays(file("points", tile, "bin"), kPoints, of_tile(made_from_, tile),
               std::array{bytes_of(points.positions), bytes_of(points.pixel_widths),
                          bytes_of(points.view_begin), bytes_of(points.view_images),
                          bytes_of(points.view_weights)});
}

std::optional<MergedPoints> TileFiles::points(std::size_t tile) const {
  const auto arrays =
      read_arrays(file("points", tile, "bin"), kPoints, of_tile(made_from_, tile), 5);
  if (!arrays) return {};
  MergedPoints points;
  points.positions = array_of<Eigen::Vector3f>((*arrays)[0]);
  points.pixel_widths = array_of<float>((*arrays)[1]);
  points.view_begin = array_of<std::size_t>((*arrays)[2]);
  points.view_images = array_of<std::uint32_t>((*arrays)[3]);
  points.view_weights = array_of<float>((*arrays)[4]);
  points.count = points.size();
  return points;
}

void TileFiles::write(std::size_t tile, const TileMesh& mesh) const {
  write_arrays(
      file("mesh", tile, "bin"), kMesh, of_tile(made_from_, tile),
      std::array{bytes_of(mesh.mesh.vertices), bytes_of(mesh.mesh.faces), bytes_of(mesh.seams)});
}

std::optional<TileMesh> TileFiles::mesh(std::size_t tile) const {
  const auto arrays = read_arrays(file("mesh", tile, "bin"), kMesh, of_tile(made_from_, tile), 3);
  if (!arrays) return {};
  TileMesh mesh;
  mesh.mesh.vertices = array_of<Eigen::Vector3f>((*arrays)[0]);
  mesh.mesh.faces = array_of<std::array<std::uint32_t, 3>>((*arrays)[1]);
  mesh.seams = array_of<std::array<std::uint32_t, 2>>((*arrays)[2]);
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
