// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary/target_ring.h"

#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "control/labels.h"
#include "control/read_control.h"
#include "control/target_places.h"
#include "io/bytes/json.h"

namespace axial::boundary {
namespace {

namespace fs = std::filesystem;

// The places by the keys of the labels. Empty: the file does not determine the place.
using Places = std::map<std::string, std::optional<Eigen::Vector3d>>;

Places places_of_survey(const fs::path& file) {
  Places places;
  const control::TargetPlaces found = control::read_target_places(file);
  for (std::size_t i = 0; i < found.targets.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    const bool is_known = found.covariance.diagonal().segment<3>(row).allFinite();
    places.emplace(control::label_key(found.targets[i].label),
                   is_known ? std::optional(found.targets[i].world) : std::nullopt);
  }
  return places;
}

Places places_of_control(const fs::path& file) {
  Places places;
  for (const control::ControlPoint& point :
       control::read_control(file, {.role = control::Role::points}).points) {
    const bool is_known = point.knows(0) && point.knows(1) && point.knows(2);
    places.emplace(control::label_key(point.label),
                   is_known ? std::optional(point.metres) : std::nullopt);
  }
  return places;
}

bool is_of_survey(const fs::path& file) {
  if (file.extension() != ".json") return false;
  const nlohmann::json content = io::read_json(file);
  return content.is_object() && content.contains("covariance_m2");
}

}  // namespace

std::vector<Eigen::Vector3d> places_of_targets(const fs::path& file,
                                               std::span<const std::string> labels) {
  const Places places = is_of_survey(file) ? places_of_survey(file) : places_of_control(file);
  std::vector<Eigen::Vector3d> corners;
  std::map<std::string, std::string> used;
  for (const std::string& label : labels) {
    const std::string key = control::label_key(label);
    if (const auto [before, is_new] = used.emplace(key, label); !is_new)
      fail_in(file, "{} '{}' is the target '{}', which is a corner already",
              setting("boundary_targets"), label, before->second);
    const auto found = places.find(key);
    if (found == places.end())
      fail_in(file, "has no target '{}' of {}", label, setting("boundary_targets"));
    if (!found->second)
      fail_in(file, "does not determine the place of the target '{}' of {}", label,
              setting("boundary_targets"));
    corners.push_back(*found->second);
  }
  return corners;
}

}  // namespace axial::boundary
