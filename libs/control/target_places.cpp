// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/target_places.h"

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "control/labels.h"
#include "io/bytes/json.h"
#include "io/bytes/json_place.h"

namespace axial::control {
namespace {

using io::JsonPlace;
using nlohmann::json;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TargetPlace place_of(const JsonPlace& entry) {
  TargetPlace place;
  place.label = entry.name("label");
  place.world = {entry.number("x"), entry.number("y"), entry.number("z")};
  const JsonPlace photographs = entry.at("photographs");
  if (!photographs.json.is_number_unsigned()) photographs.refuse("a number of photographs");
  place.photographs = photographs.json.get<std::size_t>();
  return place;
}

double covariance_at(const JsonPlace& place) {
  return place.json.is_null() ? kInfinite : place.number();
}

Eigen::MatrixXd covariance_of(const JsonPlace& place, std::size_t targets) {
  const std::vector<JsonPlace> rows = place.elements();
  const std::size_t size = 3 * targets;
  if (rows.size() != size) place.refuse(fmt::format("{} rows: three for each target", size));
  const auto count = static_cast<Eigen::Index>(size);
  Eigen::MatrixXd covariance(count, count);
  for (std::size_t i = 0; i < size; ++i) {
    const std::vector<JsonPlace> row = rows[i].elements();
    if (row.size() != size) rows[i].refuse(fmt::format("{} numbers", size));
    for (std::size_t j = 0; j < size; ++j)
      covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          covariance_at(row[j]);
  }
  return covariance;
}

void check_covariance(const Eigen::MatrixXd& covariance, const std::string& name) {
  const auto is_known = [&](Eigen::Index i) { return std::isfinite(covariance(i, i)); };
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    if (covariance(i, i) < 0)
      fail_in(name, "covariance_m2[{}][{}] is {:g}, but a variance must be 0 or more", i, i,
              covariance(i, i));
    for (Eigen::Index j = 0; j < i; ++j) {
      if (!is_known(i) || !is_known(j)) continue;
      const double scale = std::sqrt(covariance(i, i)) * std::sqrt(covariance(j, j));
      if (!(std::abs(covariance(i, j) - covariance(j, i)) <= 1e-6 * scale + 1e-15))
        fail_in(name, "covariance_m2[{}][{}] is not covariance_m2[{}][{}]", i, j, j, i);
      if (!(std::abs(covariance(i, j)) <= 1.001 * scale + 1e-15))
        fail_in(name, "covariance_m2[{}][{}] is {:g}, more than its variances allow", i, j,
                covariance(i, j));
    }
  }
}

bool is_determined(const TargetPlaces& places, std::size_t target) {
  const auto first = static_cast<Eigen::Index>(3 * target);
  return places.covariance.diagonal().segment<3>(first).allFinite();
}

}  // namespace

std::filesystem::path places_beside(const std::filesystem::path& mesh, const std::string& option) {
  const std::filesystem::path folder = mesh.parent_path();
  const std::filesystem::path inside = folder / "refined" / kTargetPlaces,
                              beside = folder / kTargetPlaces;
  if (!std::filesystem::exists(inside))
    return std::filesystem::exists(beside) ? beside : std::filesystem::path();
  if (std::filesystem::exists(beside))
    fail_in(beside, "{} is there, too; {} must state the file of the survey", inside.string(),
            option);
  return inside;
}

TargetPlaces read_target_places(const std::filesystem::path& file) {
  const std::string name = file.string();
  const json content = io::read_json(file);
  const JsonPlace whole = JsonPlace::of_file(content, file);
  TargetPlaces places;
  std::map<std::string, std::string> known;
  for (const JsonPlace& entry : whole.elements("targets")) {
    places.targets.push_back(place_of(entry));
    const std::string& label = places.targets.back().label;
    const auto [before, is_new] = known.emplace(label_key(label), label);
    if (!is_new)
      fail("{}.label is {}, but {} is in the list before", entry.where, label, before->second);
  }
  places.covariance = covariance_of(whole.at("covariance_m2"), places.targets.size());
  check_covariance(places.covariance, name);
  if (whole.has("crs")) places.crs = whole.text("crs");
  return places;
}

void write_target_places(const std::filesystem::path& file, const TargetPlaces& places) {
  json list = json::array(), rows = json::array();
  for (const TargetPlace& place : places.targets)
    list.push_back({{"label", place.label},
                    {"x", place.world.x()},
                    {"y", place.world.y()},
                    {"z", place.world.z()},
                    {"photographs", place.photographs}});
  for (Eigen::Index i = 0; i < places.covariance.rows(); ++i) {
    json row;
    // io::write_json() writes numbers that are not finite as null.
    for (Eigen::Index j = 0; j < places.covariance.cols(); ++j)
      row.push_back(places.covariance(i, j));
    rows.push_back(std::move(row));
  }
  json content{{"targets", std::move(list)}, {"covariance_m2", std::move(rows)}};
  if (!places.crs.empty()) content["crs"] = places.crs;
  io::write_json(file, content);
}

std::vector<std::pair<std::size_t, std::size_t>> common_targets(const TargetPlaces& first,
                                                                const TargetPlaces& second) {
  std::map<std::string, std::size_t> keys;
  for (std::size_t i = 0; i < second.targets.size(); ++i)
    if (is_determined(second, i)) keys.emplace(label_key(second.targets[i].label), i);
  std::vector<std::pair<std::size_t, std::size_t>> common;
  for (std::size_t i = 0; i < first.targets.size(); ++i) {
    if (!is_determined(first, i)) continue;
    const auto found = keys.find(label_key(first.targets[i].label));
    if (found != keys.end()) common.emplace_back(i, found->second);
  }
  return common;
}

}  // namespace axial::control
