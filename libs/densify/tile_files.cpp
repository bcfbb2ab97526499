// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/tile_files.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/error.h"
#include "base/file_extension.h"
#include "base/hash.h"
#include "base/other_tiles.h"
#include "io/bytes/json.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

constexpr int kTileVersion = 1;

fs::path side_file(const fs::path& ply) {
  return ply.string() + ".json";
}

// A fingerprint of the file's bytes. Empty if it cannot be read.
std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(std::size_t{1} << 20, '\0');
  Fingerprint print;
  while (in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || in.gcount() > 0)
    print.add(std::string_view(bytes).substr(0, static_cast<std::size_t>(in.gcount())));
  return in.eof() ? print.hex() : std::string();
}

// What the side file says of a cloud that is complete and still has the bytes that were written.
std::optional<nlohmann::json> side_of(const fs::path& ply) {
  std::error_code ignored;
  if (!fs::is_regular_file(ply, ignored) || !fs::is_regular_file(side_file(ply), ignored))
    return {};
  try {
    nlohmann::json side = io::read_json(side_file(ply));
    if (side.at("version") != kTileVersion || side.at("content") != content_of(ply)) return {};
    return side;
  } catch (const Error&) {
    return {};
  } catch (const nlohmann::json::exception&) {  // an entry is missing or has another type
    return {};
  }
}

std::vector<double> numbers(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

}  // namespace

fs::path tile_file(const Settings& settings, std::size_t tile) {
  return fs::path(settings.output)
      .replace_extension(fmt::format(".tile{}-{}.ply", tile, settings.fusion_tiles));
}

std::vector<fs::path> tile_outputs(const Settings& settings) {
  std::vector<fs::path> files;
  const auto add = [&](std::size_t tile) {
    files.push_back(tile_file(settings, tile));
    files.push_back(side_file(files.back()));
  };
  if (settings.tile > 0)
    add(settings.tile);
  else
    for (std::size_t tile = 1; tile <= settings.fusion_tiles; ++tile) add(tile);
  return files;
}

void finish_tile(const fs::path& ply, const std::string& made_from, const CloudCounts& counts,
                 const cloud::Tile& tile) {
  io::write_json(side_file(ply), {{"version", kTileVersion},
                                  {"made_from", made_from},
                                  {"content", content_of(ply)},
                                  {"points", counts.points},
                                  {"of_two_maps", counts.of_two},
                                  {"removed", counts.removed},
                                  {"rotation", numbers(tile.rotation.transpose().reshaped())},
                                  {"low", numbers(tile.low)},
                                  {"high", numbers(tile.high)}});
}

std::optional<CloudCounts> finished_tile(const fs::path& ply, const std::string& made_from) {
  const std::optional<nlohmann::json> side = side_of(ply);
  try {
    if (!side || side->at("made_from") != made_from) return {};
    return CloudCounts{side->at("points"), side->at("of_two_maps"), side->at("removed")};
  } catch (const nlohmann::json::exception&) {  // an entry is missing or has another type
    return {};
  }
}

void remove_tile(const fs::path& ply) {
  std::error_code ignored;
  fs::remove(ply, ignored);
  fs::remove(side_file(ply), ignored);
}

void remove_tiles(const Settings& settings) {
  for (std::size_t tile = 1; tile <= settings.fusion_tiles; ++tile)
    remove_tile(tile_file(settings, tile));
  std::vector<fs::path> foreign;
  for (const fs::path& file : other_tiles(settings.output, settings.fusion_tiles)) {
    if (lower_extension(file) != ".ply") continue;
    if (side_of(file))
      remove_tile(file);
    else
      foreign.push_back(file);
  }
  warn_of_other_tiles(foreign);
}

}  // namespace axial::densify
