// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/map_place.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>
#include <vector>

#include "axial/map.h"
#include "base/error.h"
#include "io/bytes/json.h"
#include "io/bytes/json_place.h"
#include "map/stated_place.h"
#include "map/up_direction.h"

namespace axial::map {
namespace {

template <int kRows>
Eigen::Matrix<double, kRows, kRows> matrix_at(const io::JsonPlace& place) {
  const std::vector<io::JsonPlace> rows = place.elements();
  if (rows.size() != kRows) place.refuse(fmt::format("{0} rows of {0} numbers", kRows));
  Eigen::Matrix<double, kRows, kRows> matrix;
  for (int k = 0; k < kRows; ++k) {
    const std::vector<double> row = rows[static_cast<std::size_t>(k)].numbers(kRows);
    matrix.row(k) = Eigen::Map<const Eigen::RowVector<double, kRows>>(row.data());
  }
  return matrix;
}

// An object of a comparison, which to_json() of compare/write_changes.h writes.
io::JsonPlace object_at(const nlohmann::json& whole, const char* key,
                        const std::filesystem::path& file) {
  if (!whole.is_object() || !whole.contains(key) || !whole[key].is_object())
    fail_in(file, "{} is missing: is it a comparison of CompareSurveys?", key);
  return {whole[key], file.string() + ": " + key};
}

Eigen::Isometry3d motion_in(const nlohmann::json& whole, const std::filesystem::path& file) {
  const bool is_null =
      whole.is_object() && whole.contains("registration") && whole["registration"].is_null();
  if (is_null) return Eigen::Isometry3d::Identity();  // --align none
  const io::JsonPlace matrix = object_at(whole, "registration", file).at("matrix");
  Eigen::Isometry3d motion;
  motion.matrix() = matrix_at<4>(matrix);
  if (!is_rotation(motion.linear()) || motion.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    matrix.refuse("a rotation and a translation");
  return motion;
}

MapPlace place_of_later_survey(const std::filesystem::path& file) {
  const nlohmann::json whole = io::read_json(file);
  const io::JsonPlace map = object_at(whole, "map", file);
  WorldAxes axes{matrix_at<3>(map.at("axes")), map.at("offset").vector()};
  if (!is_rotation(axes.axes)) map.at("axes").refuse("a rotation");
  return {after(motion_in(whole, file), axes), map.has_value("crs") ? map.name("crs") : ""};
}

}  // namespace

void declare_place(OptionList& list, const std::string& drawn, PlaceOptions& options) {
  const std::string map = "a map of MapSurface on which the " + drawn +
                          " were drawn, such as scene_map.dem.tif: gives axes and coordinate "
                          "reference system";
  list.add("map", &options.map, map.c_str())
      .add("up", &options.up_text, "direction of the heights in the world, X,Y,Z (default: z)")
      .add_with_default("epsg", &options.epsg,
                        "EPSG code of the coordinate reference system of the mesh, a projected one "
                        "in metres (0: none)")
      .range(0, 1 << 20);
}

void take_place(const ParsedOptions& parsed, PlaceOptions& options) {
  options.up = parse_up(options.up_text, options.epsg);
  if (options.map.empty()) return;
  for (const char* option : {"up", "epsg"})
    if (given(parsed, option)) fail("--{} contradicts --map, which states it", option);
}

Eigen::Isometry3d motion_of_comparison(const std::filesystem::path& file) {
  return motion_in(io::read_json(file), file);
}

WorldAxes after(const Eigen::Isometry3d& motion, const WorldAxes& axes) {
  return {axes.axes * motion.linear(), axes.axes * motion.translation() + axes.offset};
}

MapPlace place_of_map(const std::filesystem::path& map) {
  if (map.extension() == ".json") return place_of_later_survey(map);
  const StatedPlace stated = stated_place(map);
  if (!stated.axes) fail_in(map, "does not state its axes: is it a map of MapSurface?");
  return {*stated.axes, stated.crs};
}

MapFrame frame_on(const WorldAxes& axes, const LocalFrame& mesh_frame) {
  return {axes.axes, axes.axes * mesh_frame.origin + axes.offset};
}

MapPlace place_of(const PlaceOptions& options) {
  if (!options.map.empty()) return place_of_map(options.map);
  MapPlace place;
  if (options.epsg > 0) place.crs = crs_of_epsg(options.epsg);
  const Eigen::Vector3d up = options.up.value_or(Eigen::Vector3d::UnitZ());
  place.axes.axes = frame_with_up(up, {}).axes;
  return place;
}

}  // namespace axial::map
