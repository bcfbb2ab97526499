// SPDX-License-Identifier: GPL-3.0-or-later
// Texts that users write, and lists of written files.
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/artifacts/written_files.h"
#include "io/bytes/json.h"
#include "io/cameras/photograph_numbers.h"
#include "io/cameras/position_file.h"
#include "io/cameras/transform_file.h"
#include "reader.h"

namespace axial::fuzz {
namespace {

void read_position_file(const fs::path& file) {
  const io::PositionFile read =
      io::read_positions(file, [](const std::string& name) { return name.ends_with(".png"); });
  for (const io::NamedPosition& position : read.positions)
    require(position.line > 0 && position.position.allFinite(), "a position is not possible");
}

bool write_position_seed(const fs::path& file, int variant) {
  constexpr std::array kSeeds{
      "\xEF\xBB\xBF# name x y z\na b.png 1 -2e3 +3.5 # first\n"
      "\"a \"\" #b.png\" 4 5 6\nc#.png\t7 8 9\n",
      "# CoordinateSystem: GEOGCS[\"WGS 84\"]\n"
      "#Label,X/Longitude,Y/Latitude,Z/Altitude,Accuracy_X/Y_(m),Accuracy_Z_(m),Yaw\n"
      "a.png,15.1,-54.2,-3.5,0.1,0.2,90\n\"b\",15.1001,-54.2001,-3.5,,,\nc,,,,,,\n",
      "EPSG:4326\na.png 15.1 54.2 3 0 0 0 0.1 0.2 more\nb.png 15.2 54.3 3\n",
      "sep=;\nName;Northing;Easting;Depth\nC:\\dive\\a.PNG;1,5;2,5;3,5\n"};
  write_atomically(file, kSeeds[std::min<std::size_t>(static_cast<std::size_t>(variant), 3)]);
  return variant < 4;
}

// No file that is found lies outside the folder.
void read_file_list(const fs::path& file) {
  const fs::path folder = file.parent_path() / "again";
  if (!fs::exists(folder / "a.txt")) write_atomically(folder / "a.txt", "a");
  const io::WrittenFiles found = io::find_written(folder, io::read_json(file));
  for (const auto& paths : {found.unchanged, found.changed})
    for (const fs::path& path : paths) require(path == "a.txt", "found " + path.string());
}

bool write_list_seed(const fs::path& file, int variant) {
  const fs::path folder = file.parent_path() / "again";
  write_atomically(folder / "a.txt", "a");
  io::write_json(file, io::list_files(folder));
  return variant < 1;
}

void read_split_list(const fs::path& file) {
  const auto fields = io::split_list(read_file(file), file.string());
  require(!fields.empty(), "a list has no fields");
}

bool write_split_seed(const fs::path& file, int variant) {
  write_atomically(file, "a.png,\"b,\"\"c\"\".png\",,d");
  return variant < 1;
}

void read_transform_file(const fs::path& file) {
  const Similarity similarity = io::read_transform(file);
  const Eigen::Matrix3d product = similarity.rotation * similarity.rotation.transpose();
  require(similarity.scale > 0 && product.isIdentity(1e-8), "a matrix is no similarity");
}

bool write_transform_seed(const fs::path& file, int variant) {
  if (variant == 0) write_atomically(file, "matrix: 0, -2, 0, 5; 2, 0, 0, 1e3\n0 0 2 -7\n");
  if (variant == 1) write_atomically(file, "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  return variant < 2;
}

void read_times_file(const fs::path& file) {
  for (const auto& [name, seconds] : io::read_photograph_numbers(file, "seconds"))
    require(!name.empty() && std::isfinite(seconds), "a time is not possible");
}

bool write_times_seed(const fs::path& file, int variant) {
  write_atomically(file, "name,seconds\n# comment\na,b.png,1.5\nc.png, -2e3\n");
  return variant < 1;
}

}  // namespace

std::span<const Reader> text_readers() {
  static constexpr std::array kReaders{
      Reader{"positions", "positions.txt", read_position_file, write_position_seed},
      Reader{"file-list", "list.json", read_file_list, write_list_seed},
      Reader{"split-list", "list.txt", read_split_list, write_split_seed},
      Reader{"times", "times.csv", read_times_file, write_times_seed},
      Reader{"transform", "transform.txt", read_transform_file, write_transform_seed}};
  return kReaders;
}

}  // namespace axial::fuzz
