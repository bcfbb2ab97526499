// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "colmap/private/colmap_parts.h"
#include "colmap/private/rig_parts.h"
#include "io/bytes/json.h"
#include "io/bytes/json_place.h"

namespace axial::io {
namespace {

// The pose of a camera in the frame of its rig; empty if it is not stated.
std::optional<Pose> pose_of(const JsonPlace& camera) {
  constexpr const char *kRotation = "cam_from_rig_rotation",
                       *kTranslation = "cam_from_rig_translation";
  if (!camera.has(kRotation) && !camera.has(kTranslation)) return {};
  ColmapPose values{};
  std::ranges::copy(camera.at(kRotation).numbers(4), values.begin());
  std::ranges::copy(camera.at(kTranslation).numbers(3), values.begin() + 4);
  return pose_from_colmap(values, camera.where);
}

double sigma_of(const JsonPlace& camera, const char* key, double largest) {
  if (!camera.has(key)) return 0;
  const double sigma = camera.number(key);
  if (!(sigma > 0 && sigma <= largest))
    fail("{}.{} is {}, expected a value above 0 and at most {}", camera.where, key, sigma, largest);
  return sigma;
}

RigCamera camera_of(const JsonPlace& place) {
  place.require_object({"image_prefix", "ref_sensor", "cam_from_rig_rotation",
                        "cam_from_rig_translation", "sigma_translation", "sigma_rotation",
                        "camera_model_name", "camera_params"});
  RigCamera camera;
  camera.prefix = place.text("image_prefix");
  camera.is_reference = place.has("ref_sensor") && place.flag("ref_sensor");
  camera.pose = pose_of(place);
  if (camera.is_reference && camera.pose)
    fail_in(place.where, "states a pose of the reference camera, which is the frame of the rig");
  camera.sigma_translation = sigma_of(place, "sigma_translation", 1);
  camera.sigma_rotation = sigma_of(place, "sigma_rotation", 90);
  if (!camera.pose && (camera.sigma_translation > 0 || camera.sigma_rotation > 0))
    fail_in(place.where, "states a standard deviation of a pose that is missing");
  return camera;
}

Rig rig_of(const JsonPlace& place, std::set<std::string>& prefixes) {
  place.require_object({"cameras"});
  const JsonPlace cameras = place.at("cameras");
  if (!cameras.json.is_array() || cameras.json.empty())
    fail("{} is not a list of cameras", cameras.where);
  Rig rig;
  for (std::size_t i = 0; i < cameras.json.size(); ++i) {
    const JsonPlace camera{cameras.json[i], fmt::format("{}, camera {}", place.where, i + 1)};
    rig.cameras.push_back(camera_of(camera));
    if (const std::string& prefix = rig.cameras.back().prefix; !prefixes.insert(prefix).second)
      fail_in(camera.where, "image_prefix '{}' occurs twice", prefix);
  }
  if (const auto count = std::ranges::count(rig.cameras, true, &RigCamera::is_reference);
      count != 1)
    fail_in(place.where, "has {} cameras with ref_sensor true, expected one", count);
  return rig;
}

}  // namespace

std::vector<Rig> read_rig_config(const std::filesystem::path& path) {
  const nlohmann::json json = read_json(path);
  if (!json.is_array() || json.empty()) fail_in(path, "is not a list of rigs");
  std::vector<Rig> rigs;
  std::set<std::string> prefixes;
  for (std::size_t i = 0; i < json.size(); ++i)
    rigs.push_back(rig_of({json[i], fmt::format("{}: rig {}", path.string(), i + 1)}, prefixes));
  return rigs;
}

}  // namespace axial::io
