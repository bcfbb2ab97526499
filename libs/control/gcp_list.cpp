// SPDX-License-Identifier: GPL-3.0-or-later
// gcp_list.txt of OpenDroneMap.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "base/error.h"
#include "base/file_extension.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "private/readers.h"
#include "private/stated_points.h"

namespace axial::control {
namespace {

bool states_a_system(std::string_view line) {
  const std::string words = lower_case(std::string(line));
  return words.starts_with("epsg:") || words.starts_with("+proj=") || words.starts_with("wgs84") ||
         words.starts_with("wgs 84");
}

// The words between blanks; between tabs, if tabs separate the six words that a line has at least.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words = split(line, '\t');
  if (words.size() >= 6) {
    for (std::string_view& word : words) word = trimmed(word);
    return words;
  }
  words.clear();
  for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
    const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return words;
}

double number_of(std::string_view word, const char* field, const std::string& where) {
  const auto number = parse_number<double>(word);
  if (!number) fail_in(where, "{} is '{}', which is not a number", field, word);
  return *number;
}

// The points of a file, by name or by coordinates.
class Points {
 public:
  // The label of the point; `name` may be empty.
  std::string add(const Eigen::Vector3d& place, std::string_view name, const std::string& where) {
    std::string label(name);
    if (label.empty()) {
      const std::array key{place.x(), place.y(), std::isnan(place.z()) ? 0 : place.z()};
      const auto known = names_.find(key);
      label = known != names_.end() ? known->second : fmt::format("point {}", names_.size() + 1);
      names_.emplace(key, label);
    }
    StatedPoint point;
    point.label = label;
    point.place = place;
    point.where = where;
    points_.push_back(std::move(point));
    return label;
  }

  std::vector<StatedPoint> take() { return std::move(points_); }

 private:
  std::map<std::array<double, 3>, std::string> names_;
  std::vector<StatedPoint> points_;
};

TargetImage observation(std::span<const std::string_view> words, Points& points,
                        const std::string& where) {
  if (words.size() < 6) fail_in(where, "must be X Y Z IM_X IM_Y IMAGE [NAME]");
  const double x = finite(number_of(words[0], "geo_x", where), where, "geo_x");
  const double y = finite(number_of(words[1], "geo_y", where), where, "geo_y");
  const double z = number_of(words[2], "geo_z", where);
  if (std::isinf(z)) finite(z, where, "geo_z");
  TargetImage image;
  image.pixel = {finite(number_of(words[3], "im_x", where), where, "im_x"),
                 finite(number_of(words[4], "im_y", where), where, "im_y")};
  image.image = words[5];
  image.where = where;
  if (image.image.empty()) fail_in(where, "the name of the photograph is empty");
  image.label = points.add({x, y, z}, words.size() > 6 ? words[6] : std::string_view(), where);
  return image;
}

}  // namespace

bool is_gcp_list(const std::string& text) {
  for (const std::string_view line : split(text, '\n'))
    if (const std::string_view content = trimmed(line);
        !content.empty() && !content.starts_with('#'))
      return states_a_system(content);
  return false;
}

Control read_gcp_list(const std::string& text, const std::filesystem::path& file,
                      const ControlReading& options) {
  Control control;
  StatedPoints stated;
  Points points;
  int number = 0;
  for (const std::string_view line : split(text, '\n')) {
    const std::string where = fmt::format("{}:{}", file.string(), ++number);
    const std::string_view content = trimmed(line);
    if (content.empty() || content.starts_with('#')) continue;
    if (stated.crs.empty()) {
      stated.crs = content;
      stated.crs_where = where;
      continue;
    }
    control.images.push_back(observation(words_of(content), points, where));
  }
  stated.points = points.take();
  add_points(std::move(stated), file, options, control);
  return control;
}

}  // namespace axial::control
