// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/write_changes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/atomic_file.h"
#include "compare/draw_changes.h"
#include "compare/registration.h"
#include "io/bytes/json.h"
#include "io/images/image.h"
#include "map/geotiff.h"
#include "map/stated_kind.h"

namespace axial::compare {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRegions = 1000;  // in the report
constexpr int kJpegQuality = 92;
constexpr double kDegrees = 180 / std::numbers::pi;

Json list_of(const Eigen::VectorXd& values) {
  return std::vector<double>(values.begin(), values.end());
}

Json json_of(const Volume& volume, std::size_t regions) {
  return {{"volume", volume.volume},
          {"volume_sigma", volume.sigma},
          {"area", volume.area},
          {"regions", regions}};
}

Json rows_of(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index k = 0; k < matrix.rows(); ++k)
    rows.push_back(list_of(matrix.row(k).transpose()));
  return rows;
}

// Of the map, for place_of_map() (map/map_place.h).
Json json_of(const map::MapGrid& grid, const map::WorldAxes& axes, const std::string& crs) {
  const Json rows = rows_of(axes.axes);
  return {{"pixel", grid.pixel},
          {"columns", grid.columns},
          {"rows", grid.rows},
          {"left", grid.left},
          {"top", grid.top},
          {"up", rows[2]},
          {"axes", rows},
          {"offset", list_of(axes.offset)},
          {"crs", crs.empty() ? Json() : Json(crs)}};
}

Json json_of(const Registration& registration, const map::WorldAxes& map, double sigma) {
  const RigidMotion& motion = registration.motion;
  const Eigen::AngleAxisd turn(motion.rotation);
  const Vector6d sigmas = registration.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  return {{"converged", registration.converged},
          {"iterations", registration.iterations},
          {"determined_directions", registration.determined},
          {"share_of_samples_used", registration.share_used},
          {"residual_sigma", registration.residual_sigma},
          {"centre", list_of(motion.centre)},
          {"translation", list_of(motion.translation)},
          {"translation_sigma", list_of(sigmas.tail<3>())},
          {"rotation_degrees", list_of(turn.angle() * kDegrees * turn.axis())},
          {"rotation_degrees_sigma", list_of(sigmas.head<3>() * kDegrees)},
          {"height_sigma", sigma},
          {"matrix", rows_of(in_world(motion, map).matrix())}};
}

// Adds what the targets tell to the object of a registration.
void add_targets(const TargetRegistration& found, const std::vector<std::string>& labels,
                 Json& json) {
  json["matrix"] = rows_of(found.motion.matrix());
  Json targets = Json::array();
  for (std::size_t i = 0; i < labels.size(); ++i)
    targets.push_back({{"label", labels[i]},
                       {"moved", std::ranges::find(found.moved, i) != found.moved.end()},
                       {"residual", list_of(found.residuals.col(static_cast<Eigen::Index>(i)))}});
  json["targets"] = std::move(targets);
  json["chi_squared"] = found.chi_squared;
  json["degrees_of_freedom"] = found.freedom;
  json["scale"] = found.scale;
  json["scale_sigma"] = found.scale_sigma;
}

Json json_of(const PlaceAgreement& place) {
  const Json same =
      place.verdict == PlaceVerdict::unknown ? Json() : Json(place.verdict == PlaceVerdict::same);
  return {{"same", same},
          {"correlation", place.correlation},
          {"least", place.least},
          {"by_chance", place.chance},
          {"relief", place.relief}};
}

Json json_of(const Noise& noise) {
  return {{"given", noise.is_given},        {"sigma", noise.typical},
          {"local_sigma", noise.local},     {"lowest_sigma", noise.lowest},
          {"highest_sigma", noise.highest}, {"correlated_pixels", noise.correlation}};
}

Json json_of(const std::vector<Region>& regions) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(regions.size(), kMostRegions); ++i) {
    const Region& region = regions[i];
    list.push_back({{"change", region.came ? "came" : "gone"},
                    {"volume", region.size.volume},
                    {"volume_sigma", region.size.sigma},
                    {"area", region.size.area},
                    {"largest_difference", region.largest},
                    {"x", region.x},
                    {"y", region.y}});
  }
  return list;
}

void write_map(const fs::path& path, map::MapKind kind, const char* stated, const cv::Mat& pixels,
               const Comparison& comparison, const ChangeFacts& facts) {
  map::GeoTiff file(path, kind, comparison.grid, facts.crs);
  file.state_kind(stated);
  file.state_axes(map::world_axes(comparison.frame, facts.mesh_frame));
  file.write(cv::Rect({}, pixels.size()), pixels);
  file.finish();
}

// A map of heights or of their differences, as files state them.
cv::Mat1f with_no_height(const cv::Mat1f& values) {
  cv::Mat1f result = values.clone();
  for (float& value : result)
    if (std::isnan(value)) value = map::kNoHeight;
  return result;
}

}  // namespace

Json to_json(const Comparison& comparison, const ChangeFacts& facts) {
  const Changes& changes = comparison.changes;
  const auto came = static_cast<std::size_t>(
      std::ranges::count_if(changes.regions, [](const Region& r) { return r.came; }));
  const map::WorldAxes map = map::world_axes(comparison.frame, facts.mesh_frame);
  Json json{{"before", facts.before},
            {"after", facts.after},
            {"map", json_of(comparison.grid, map, facts.crs)},
            {"area_compared", changes.area_compared},
            {"area_unseen", comparison.area_unseen},
            {"area_changed", changes.came.area + changes.gone.area},
            {"came", json_of(changes.came, came)},
            {"gone", json_of(changes.gone, changes.regions.size() - came)},
            {"net", {{"volume", changes.net}, {"volume_sigma", changes.net_sigma}}},
            {"noise", json_of(comparison.noise)},
            {"place", json_of(comparison.place)}};
  json["registration"] =
      facts.aligned ? json_of(comparison.registration, map, comparison.registration_sigma) : Json();
  if (facts.by_targets) add_targets(*facts.by_targets, facts.labels, json["registration"]);
  json["regions"] = json_of(changes.regions);
  return json;
}

void write_changes(const ChangeFiles& files, const Comparison& comparison,
                   const ChangeFacts& facts) {
  for (const fs::path& path : files.all())  // of the blocks of maps, too
    remove_abandoned(path.parent_path(), path.stem().string());
  write_together(files.all(), [&](const std::vector<fs::path>& temporary) {
    write_map(temporary[0], map::MapKind::heights, map::kinds::kDifference,
              with_no_height(comparison.difference), comparison, facts);
    write_map(temporary[1], map::MapKind::classes, map::kinds::kSignificant,
              comparison.changes.classes, comparison, facts);
    write_map(temporary[2], map::MapKind::heights, map::kinds::kSigma,
              with_no_height(comparison.sigma), comparison, facts);
    write_atomically(temporary[3], io::to_text(to_json(comparison, facts), 1) + "\n");
    io::write_jpeg(temporary[4], draw_changes(comparison, facts.is_georeferenced), kJpegQuality);
  });
}

}  // namespace axial::compare
