// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/target_places.h"

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "control/labels.h"
#include "io/bytes/json.h"
#include "io/bytes/json_entry.h"

namespace axial::control {
namespace {

using nlohmann::json;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

const json& list_at(const json& content, const char* key, const std::string& name) {
  const auto found = content.is_object() ? content.find(key) : content.end();
  if (!content.is_object() || found == content.end() || !found->is_array())
    fail_in(name, "{} must be a list", key);
  return *found;
}

TargetPlace place_of(const io::Entry& entry) {
  TargetPlace place;
  place.label = entry.text("label");
  place.world = {entry.number("x"), entry.number("y"), entry.number("z")};
  const json* photographs = entry.find("photographs");
  if (!photographs || !photographs->is_number_unsigned())
    entry.refuse("photographs", "a number of photographs");
  place.photographs = photographs->get<std::size_t>();
  return place;
}

double covariance_at(const json& value, const std::string& where) {
  if (value.is_null()) return kInfinite;
  if (!io::is_finite_number(value))
    fail("{} is {}, but must be a finite number", where, io::to_text(value));
  return value.get<double>();
}

Eigen::MatrixXd covariance_of(const json& rows, std::size_t targets, const std::string& name) {
  const std::string where = name + ": covariance_m2";
  const std::size_t size = 3 * targets;
  if (rows.size() != size)
    fail("{} has {} rows, but must have {}: three for each target", where, rows.size(), size);
  const auto count = static_cast<Eigen::Index>(size);
  Eigen::MatrixXd covariance(count, count);
  for (std::size_t i = 0; i < size; ++i) {
    if (!rows[i].is_array() || rows[i].size() != size)
      fail("{}[{}] must be a list of {} numbers", where, i, size);
    for (std::size_t j = 0; j < size; ++j)
      covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          covariance_at(rows[i][j], fmt::format("{}[{}][{}]", where, i, j));
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
  const json& list = list_at(content, "targets", name);
  const json& rows = list_at(content, "covariance_m2", name);
  TargetPlaces places;
  std::map<std::string, std::string> known;
  io::for_each_entry(content, name, "targets", [&](const io::Entry& entry) {
    places.targets.push_back(place_of(entry));
    const std::string& label = places.targets.back().label;
    const auto [before, is_new] = known.emplace(label_key(label), label);
    if (!is_new)
      fail("{}.label is {}, but {} is in the list before", entry.where, label, before->second);
  });
  places.covariance = covariance_of(rows, list.size(), name);
  check_covariance(places.covariance, name);
  if (const auto crs = content.find("crs"); crs != content.end()) {
    if (!crs->is_string()) fail_in(name, "crs is {}, but must be a text", io::to_text(*crs));
    places.crs = crs->get<std::string>();
  }
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
