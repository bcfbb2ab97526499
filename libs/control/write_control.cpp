// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/write_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/split.h"
#include "control/labels.h"
#include "io/bytes/json.h"
#include "private/coordinate_system.h"

namespace axial::control {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json json_of(const ControlPoint& point) {
  constexpr std::array kKeys{"x", "y", "z"};
  json result = {{"label", point.label}};
  json sigma = json::array();
  for (int k = 0; k < 3; ++k) {
    sigma.push_back(point.knows(k) ? point.sigma[k] : 0);
    if (point.knows(k)) result[kKeys[static_cast<std::size_t>(k)]] = point.metres[k];
  }
  result["sigma"] = sigma;
  if (point.check) result["check"] = true;
  return result;
}

json json_of(const Bar& bar) {
  json result = {
      {"targets", {bar.first, bar.second}}, {"length", bar.metres}, {"sigma", bar.sigma}};
  if (bar.check) result["check"] = true;
  return result;
}

json json_of(const TargetImage& image) {
  json result = {{"label", image.label},
                 {"image", image.image},
                 {"x", image.pixel.x()},
                 {"y", image.pixel.y()},
                 {"sigma", image.sigma}};
  if (image.corners)
    for (const Eigen::Vector2d& corner : *image.corners)
      result["corners"].push_back({corner.x(), corner.y()});
  if (!image.dot.isZero(0)) result["dot"] = {image.dot(0, 0), image.dot(0, 1), image.dot(1, 1)};
  return result;
}

// A field of a table: in quotes if it needs them.
std::string field_of(const std::string& text, const fs::path& file) {
  if (text.find_first_of("\r\n") != std::string::npos || text.find('\0') != std::string::npos)
    fail_in(file, "cannot be written: the label '{}' has several lines", text);
  const bool plain = text.find_first_of(",;\t\"#") == std::string::npos && trimmed(text) == text;
  if (plain) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string number_or_empty(const ControlPoint& point, int coordinate) {
  return point.knows(coordinate) ? fmt::format("{}", point.metres[coordinate]) : "";
}

std::string sigma_or_empty(const ControlPoint& point, int coordinate) {
  return point.knows(coordinate) ? fmt::format("{}", point.sigma[coordinate]) : "";
}

CoordinateSystem system_of(const Control& control, const fs::path& file) {
  if (control.crs.empty())
    fail_in(file, "cannot be written: the points have no coordinate reference system");
  auto system = CoordinateSystem::from_text(control.crs);
  if (!system)
    fail_in(file, "cannot be written: '{}' is no coordinate reference system that PROJ knows",
            control.crs);
  return *std::move(system);
}

std::string underscored(std::string text) {
  std::ranges::replace(text, ' ', '_');
  return text;
}

void require_one_word(const std::string& text, const char* what, const fs::path& file) {
  if (text.empty() || text.find_first_of(kBlanks) != std::string::npos ||
      text.find('\0') != std::string::npos)
    fail_in(file, "cannot be written: {} '{}' must be one word", what, text);
}

// Longitude and latitude of the points whose place is known, in their order.
std::vector<Eigen::Vector2d> degrees_of(const Control& control, const fs::path& file) {
  std::vector<Eigen::Vector2d> places;
  for (const ControlPoint& point : control.points)
    if (point.knows(0) && point.knows(1)) places.emplace_back(point.metres.head<2>());
  if (places.empty()) return places;
  const auto degrees =
      transformed(places, system_of(control, file), *CoordinateSystem::from_text("EPSG:4326"));
  for (std::size_t i = 0; i < degrees.size(); ++i)
    if (!degrees[i].allFinite())
      fail_in(file, "cannot be written: {} {} has no longitude and latitude", places[i].x(),
              places[i].y());
  return degrees;
}

}  // namespace

void write_control_json(const fs::path& file, const Control& control) {
  json content = {{"pixels", "the corner of the first pixel is (0, 0), its centre is (0.5, 0.5)"}};
  if (!control.crs.empty()) content["crs"] = control.crs;
  const auto add = [&](const char* key, const auto& items) {
    content[key] = json::array();
    for (const auto& item : items) content[key].push_back(json_of(item));
  };
  add("points", control.points);
  add("bars", control.bars);
  add("targets", control.images);
  io::write_json(file, content);
}

void write_gcp_list(const fs::path& file, const Control& control) {
  std::map<std::string, const ControlPoint*> points;
  for (const ControlPoint& point : control.points)
    if (point.knows(0) && point.knows(1)) points.emplace(label_key(point.label), &point);
  std::string lines;
  for (const TargetImage& image : control.images) {
    const auto found = points.find(label_key(image.label));
    if (found == points.end()) continue;
    const ControlPoint& point = *found->second;
    const std::string label = underscored(image.label);
    require_one_word(image.image, "the name of the photograph", file);
    require_one_word(label, "the label", file);
    lines += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{}\n", point.metres.x(), point.metres.y(),
                         point.knows(2) ? fmt::format("{}", point.metres.z()) : "NaN",
                         image.pixel.x(), image.pixel.y(), image.image, label);
  }
  if (lines.empty())
    fail_in(file, "cannot be written: no target in a photograph is a control point");
  const std::string name = system_of(control, file).name();
  require_one_word(name, "the coordinate reference system", file);
  write_atomically(file, name + "\n" + lines);
}

void write_metashape_reference(const fs::path& file, const Control& control) {
  std::string text;
  if (!control.crs.empty()) text = "# CoordinateSystem: " + system_of(control, file).wkt() + "\n";
  text +=
      "#Label,X/Easting,Y/Northing,Z/Altitude,Accuracy_X_(m),Accuracy_Y_(m),Accuracy_Z_(m),"
      "Enabled\n";
  for (const ControlPoint& point : control.points) {
    text += field_of(point.label, file);
    for (int k = 0; k < 3; ++k) text += ',' + number_or_empty(point, k);
    for (int k = 0; k < 3; ++k) text += ',' + sigma_or_empty(point, k);
    text += point.check ? ",0\n" : ",1\n";
  }
  write_atomically(file, text);
}

void write_reefshape_bars(const fs::path& file, const Control& control) {
  std::string text;
  for (const Bar& bar : control.bars)
    text += fmt::format("{},{},{},{}{}\n", field_of(bar.first, file), field_of(bar.second, file),
                        bar.metres, bar.sigma, bar.check ? ",check" : "");
  write_atomically(file, text);
}

void write_reefshape_control(const fs::path& file, const Control& control) {
  const std::vector<Eigen::Vector2d> degrees = degrees_of(control, file);
  const bool checks = std::ranges::any_of(control.points, &ControlPoint::check);
  std::string text = fmt::format("label,lat,lon,depth,xyAcc,zAcc{}\n", checks ? ",check" : "");
  std::size_t next = 0;
  for (const ControlPoint& point : control.points) {
    if (point.knows(2) && point.metres.z() > 0)
      fail_in(file, "cannot be written: {} lies {} m above the surface", point.label,
              point.metres.z());
    std::string place = ",", sigma;
    if (point.knows(0) && point.knows(1)) {
      place = fmt::format("{},{}", degrees[next].y(), degrees[next].x());
      sigma = fmt::format("{}", point.sigma.head<2>().maxCoeff());
      ++next;
    }
    text += fmt::format("{},{},{},{},{}{}\n", field_of(point.label, file), place,
                        number_or_empty(point, 2), sigma, sigma_or_empty(point, 2),
                        !checks       ? ""
                        : point.check ? ",1"
                                      : ",0");
  }
  write_atomically(file, text);
}

}  // namespace axial::control
