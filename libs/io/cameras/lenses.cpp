// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/lenses.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/program/output_name.h"
#include "cameras/private/image_names.h"
#include "cameras/private/port_json.h"
#include "scene/camera_model.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using Distortion = refractive::LensDistortion<double>;

void read_definitions(const JsonPlace& place, SceneLenses& lenses) {
  for (const std::string& name : place.keys()) {
    if (name == kNone || name.empty())
      fail_in(place.where, "'{}' cannot be the name of a lens ('none' means no distortion)", name);
    lenses.lenses[name] = distortion_from_json(place.at(name));
  }
}

const std::string& name_for(const SceneLenses& lenses, const std::string& image) {
  const auto entry = entry_of(lenses.images, image);
  return entry == lenses.images.end() ? lenses.default_lens : entry->second;
}

bool images_anything(const CameraModel& camera) {
  return distorted_lens<double>(camera).field > 0;
}

// The end of an image's path that stays the same when the scene's folder is moved.
std::string name_beside(const fs::path& scene_path, const std::string& image) {
  const fs::path from = fs::absolute(scene_path).parent_path();
  fs::path name;
  for (const fs::path& part : fs::absolute(image).lexically_normal().lexically_relative(from))
    if (part != "..") name /= part;
  return name.generic_string();
}

// Returns the name of the lens. A new distortion gets a new name.
std::string named(SceneLenses& lenses, const std::optional<Distortion>& distortion) {
  if (!distortion) return kNone;
  for (const auto& [name, known] : lenses.lenses)
    if (known == *distortion) return name;
  const std::string name = fmt::format("lens_{}", lenses.lenses.size() + 1);
  lenses.lenses[name] = *distortion;
  return name;
}

// Readers find an entry by the end of the whole path. Checks that they will find the right lens for
// every image.
void check_names(const SceneLenses& lenses, const Scene& scene, const fs::path& file) {
  for (const SceneImage& image : scene.images) {
    if (!image.calibrated) continue;
    const std::string path = fs::path(image.path).generic_string();
    const std::string& name = name_for(lenses, path);
    const std::optional<Distortion> read =
        name == kNone ? std::nullopt : std::optional(lenses.lenses.at(name));
    if (read != image.camera.distortion)
      fail_in(file,
              "images: the end of the path of {} matches another image, with lens '{}': rename a "
              "folder",
              path, name);
  }
}

}  // namespace

fs::path lenses_beside(const fs::path& scene_path) {
  return with_extension(scene_path, ".lenses.json");
}

SceneLenses read_lenses(const fs::path& path) {
  const nlohmann::json json = read_json(path);
  const JsonPlace root{json, path.string() + ": lenses"};
  root.require_object({"version", "lenses", "default", "images"});
  root.require_version_1();
  SceneLenses lenses;
  read_definitions(root.at("lenses"), lenses);
  lenses.default_lens = defined_name(root, "default", lenses.lenses, "lens");
  if (root.has("images")) lenses.images = names_by_image(root.at("images"), lenses.lenses, "lens");
  return lenses;
}

void write_lenses(const fs::path& path, const SceneLenses& lenses) {
  nlohmann::json json{{"version", 1}, {"default", lenses.default_lens}};
  json["lenses"] = nlohmann::json::object();
  for (const auto& [name, lens] : lenses.lenses) json["lenses"][name] = distortion_to_json(lens);
  for (const auto& [image, name] : lenses.images) json["images"][image] = name;
  write_json(path, json);
}

SceneLenses lenses_of(const Scene& scene, const fs::path& scene_path) {
  SceneLenses lenses;
  std::vector<std::string> names, paths, values;
  const auto add = [&](const SceneImage& image, const std::string& lens) {
    names.push_back(name_beside(scene_path, image.path));
    paths.push_back(fs::path(image.path).generic_string());
    values.push_back(lens);
  };
  for (const SceneImage& image : scene.images)
    if (image.calibrated) add(image, named(lenses, image.camera.distortion));
  if (!values.empty()) lenses.default_lens = values.front();
  // Images without a pose need no lens, but must not match the entries of other images.
  for (const SceneImage& image : scene.images)
    if (!image.calibrated) add(image, lenses.default_lens);
  lenses.images = entries_for(names, paths, values, lenses.default_lens);
  check_names(lenses, scene, lenses_beside(scene_path));
  return lenses;
}

void attach_lenses(Scene& scene, const SceneLenses& lenses, const fs::path& file,
                   const Context& context) {
  const UseEntry use = [&](SceneImage& image, auto entry) {
    if (!image.calibrated) return;
    const std::string& name = entry == lenses.images.end() ? lenses.default_lens : entry->second;
    image.camera.distortion.reset();
    if (name == kNone) return;
    image.camera.distortion = lenses.lenses.at(name);
    if (!images_anything(image.camera))
      fail_in(file, "lenses.{}: is not a valid lens for {}: it mirrors the image", name,
              image.path);
  };
  for_each_entry(scene, lenses.images, file.string(), "lenses.images", use, context);
}

bool attach_lenses_beside(Scene& scene, const fs::path& scene_path, const Context& context) {
  const fs::path file = lenses_beside(scene_path);
  std::error_code error;
  if (!fs::exists(file, error)) return false;
  attach_lenses(scene, read_lenses(file), file, context);
  return std::ranges::any_of(
      scene.images, [](const SceneImage& image) { return image.camera.distortion.has_value(); });
}

void write_lenses_beside(const fs::path& scene_path, const SceneLenses& lenses, bool behind_ports) {
  const fs::path file = lenses_beside(scene_path);
  if (behind_ports || !lenses.lenses.empty()) return write_lenses(file, lenses);
  std::error_code error;
  fs::remove(file, error);
}

}  // namespace axial::io
