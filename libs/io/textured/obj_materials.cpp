// SPDX-License-Identifier: GPL-3.0-or-later
#include "textured/private/obj_materials.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "textured/private/file_names.h"

namespace axial::io {

namespace fs = std::filesystem;

std::optional<TextLine> ObjLines::next() {
  while (std::optional<TextLine> line = reader_.line()) {
    ++number_;
    if (line->empty()) continue;
    if (!line->rest().ends_with('\\')) return line;
    const std::size_t first = number_;
    joined_.clear();
    while (line && line->rest().ends_with('\\')) {
      joined_ += line->rest();
      joined_.back() = ' ';
      line = reader_.line();
      number_ += line.has_value();
    }
    if (line) joined_ += line->rest();
    const TextLine joined(joined_, file_, first);
    if (!joined.empty()) return joined;
  }
  return {};
}

namespace {

// Takes up to `most` numbers from the beginning of `line`; the file name follows them.
std::vector<double> take_numbers(TextLine& line, std::size_t most) {
  std::vector<double> numbers;
  while (numbers.size() < most && !line.empty()) {
    TextLine after = line;
    const auto number = parse_finite<double>(after.word("option"));
    if (!number) break;
    numbers.push_back(*number);
    line = after;
  }
  return numbers;
}

// The options of map_Kd and the largest number of their values. -clamp and the blend options have a
// word, the other options have numbers.
struct MapOption {
  std::string_view name;
  std::size_t values;
  bool word = false;
};
constexpr std::array<MapOption, 11> kMapOptions{{{"-o", 3},
                                                 {"-s", 3},
                                                 {"-t", 3},
                                                 {"-mm", 2},
                                                 {"-bm", 1},
                                                 {"-boost", 1},
                                                 {"-texres", 2},
                                                 {"-clamp", 1, true},
                                                 {"-blendu", 1, true},
                                                 {"-blendv", 1, true},
                                                 {"-cc", 1, true}}};

void set_pair(Eigen::Vector2d& pair, const std::vector<double>& numbers, const TextLine& line,
              std::string_view option) {
  if (numbers.empty()) fail_in(line.where(), "{} has no number", option);
  for (std::size_t k = 0; k < std::min<std::size_t>(numbers.size(), 2); ++k)
    pair[static_cast<Eigen::Index>(k)] = numbers[k];
}

void read_map_option(const MapOption& option, TextLine& line, ObjMaterial& material) {
  if (option.word) {
    const std::string value = lower_case(std::string(line.word(option.name)));
    if (value != "on" && value != "off")
      fail_in(line.where(), "{} is '{}', expected on or off", option.name, value);
    if (option.name == "-clamp" && value == "on") material.texture->wrap.fill(Wrap::clamp);
    return;
  }
  const std::vector<double> numbers = take_numbers(line, option.values);
  if (option.name == "-o") set_pair(material.offset, numbers, line, option.name);
  if (option.name == "-s") set_pair(material.scale, numbers, line, option.name);
  const bool turbulent = std::ranges::any_of(numbers, [](double value) { return value != 0; });
  if (option.name == "-t" && turbulent)
    fail_in(line.where(), "the option -t of map_Kd is not supported");
}

// `line`: after the key map_Kd.
void read_map(TextLine line, const fs::path& folder, ObjMaterial& material) {
  material.texture.emplace().wrap.fill(Wrap::repeat);
  material.scale = {1, 1};
  material.offset = {0, 0};
  while (!line.empty()) {
    TextLine after = line;
    const std::string name = lower_case(std::string(after.word("option")));
    const auto option = std::ranges::find(kMapOptions, name, &MapOption::name);
    if (option == kMapOptions.end()) break;
    line = after;
    read_map_option(*option, line, material);
  }
  std::string name(line.file_name());
  if (name.empty()) fail_in(line.where(), "map_Kd names no file");
  const bool quoted = name.size() > 2 && name.front() == '"' && name.back() == '"';
  if (quoted && !file_beside(folder, name)) name = name.substr(1, name.size() - 2);
  material.texture->file = path_beside(folder, name);
}

// Kd has one or three numbers from 0 to 1. Colours of other kinds count as white.
Rgb diffuse_color(TextLine line) {
  const std::vector<double> numbers = take_numbers(line, 3);
  Rgb color{255, 255, 255};
  if (numbers.empty()) return color;
  for (std::size_t k = 0; k < 3; ++k) {
    const double value = numbers.size() == 3 ? numbers[k] : numbers[0];
    color[k] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
  }
  return color;
}

}  // namespace

std::vector<ObjMaterial> read_obj_materials(const fs::path& mtl) {
  const std::string bytes = read_file(mtl);
  ObjLines lines(bytes, mtl.string());
  std::vector<ObjMaterial> materials;
  while (std::optional<TextLine> line = lines.next()) {
    const std::string key = lower_case(std::string(line->word("key")));
    if (key == "newmtl") materials.emplace_back().name = line->rest();
    if (materials.empty()) continue;
    if (key == "map_kd") read_map(*line, mtl.parent_path(), materials.back());
    if (key == "kd") materials.back().color = diffuse_color(*line);
  }
  return materials;
}

std::vector<fs::path> material_files(const fs::path& folder, std::string_view names) {
  // Each beginning of the names costs a look into the folder. A line of a megabyte would take
  // hours.
  constexpr std::size_t kLongestName = 1024;
  std::vector<fs::path> files;
  while (!names.empty()) {
    // The longest beginning, up to a blank, that names a file.
    std::size_t end = std::min(names.size(), kLongestName);
    std::optional<fs::path> found;
    while (!(found = file_beside(folder, std::string(names.substr(0, end))))) {
      const std::size_t blank = names.find_last_of(kBlanks, end - 1);
      if (blank == std::string_view::npos || blank == 0) break;
      end = names.find_last_not_of(kBlanks, blank) + 1;
      if (end == 0) break;
    }
    if (!found) return {folder / names};
    files.push_back(*found);
    names = trimmed(names.substr(end));
  }
  return files;
}

}  // namespace axial::io
