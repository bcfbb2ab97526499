// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap.h"

#include <algorithm>
#include <array>
#include <span>
#include <unordered_map>
#include <unordered_set>

#include "base/error.h"
#include "cameras/private/port_values.h"
#include "colmap/private/colmap_parts.h"
#include "io/colmap/calibmar.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

bool has_cameras(const fs::path& folder) {
  return has_part(folder, "cameras", ModelForm::text) ||
         has_part(folder, "cameras", ModelForm::binary);
}

bool holds_any_model(const fs::path& folder) {
  return holds_model(folder, ModelForm::text) || holds_model(folder, ModelForm::binary);
}

// Complete models that a user of `folder` may have meant instead of `taken`: models in the other
// places, and models beside DIR/sparse/0 that COLMAP could not merge with it.
std::vector<std::string> other_models(std::span<const fs::path> places, const fs::path& taken) {
  std::vector<std::string> others;
  for (const fs::path& place : places)
    if (place != taken && holds_any_model(place)) others.push_back(place.string());
  for (int i = 1; taken.filename() == "0"; ++i) {
    const fs::path next = taken.parent_path() / std::to_string(i);
    if (!holds_any_model(next)) break;
    others.push_back(next.string());
  }
  return others;
}

template <class T>
void require_unique_ids(const std::vector<T>& items, const char* what, const std::string& model) {
  std::unordered_set<std::uint64_t> seen;
  for (const T& item : items)
    if (!seen.insert(item.id).second) fail_in(model, "{} {} occurs twice", what, item.id);
}

// An image is identified by its normalised path relative to the image folder.
void require_unique_names(const ColmapModel& model, const std::string& where) {
  std::unordered_map<std::string, std::uint32_t> seen;
  for (const ColmapImage& image : model.images) {
    const std::string path = fs::path(image.name).lexically_normal().generic_string();
    const auto [other, added] = seen.emplace(path, image.id);
    if (!added)
      fail_in(where, "images {} and {} have the same name, {}", other->second, image.id,
              image.name);
  }
}

void check_references(const ColmapModel& model, const std::string& where) {
  std::unordered_set<std::uint32_t> cameras;
  for (const ColmapCamera& camera : model.cameras) cameras.insert(camera.id);
  std::unordered_set<std::uint64_t> points;
  for (const ColmapPoint3D& point : model.points) points.insert(point.id);
  std::unordered_map<std::uint32_t, std::size_t> observations;
  for (const ColmapImage& image : model.images) {
    if (!cameras.contains(image.camera))
      fail_in(where, "image {} ({}) refers to camera {}, which does not exist", image.id,
              image.name, image.camera);
    for (const ColmapPoint2D& point : image.points)
      if (point.point3d != kNoPoint3D && !points.contains(point.point3d))
        fail_in(where, "image {} ({}) refers to 3D point {}, which does not exist", image.id,
                image.name, point.point3d);
    observations[image.id] = image.points.size();
  }
  for (const ColmapPoint3D& point : model.points)
    for (const ColmapTrackElement& element : point.track) {
      const auto found = observations.find(element.image);
      if (found == observations.end())
        fail_in(where, "3D point {} refers to image {}, which does not exist", point.id,
                element.image);
      if (element.point2d >= found->second)
        fail_in(where, "3D point {} refers to 2D point {} of image {}, which has {}", point.id,
                element.point2d, element.image, found->second);
    }
}

}  // namespace

fs::path find_colmap_model(const fs::path& folder, const Context& context) {
  const std::array<fs::path, 3> places{folder / "sparse", folder / "sparse" / "0", folder};
  auto taken = std::ranges::find_if(places, holds_any_model);
  // If no model is complete, the reader's message says which files are missing.
  if (taken == places.end()) taken = std::ranges::find_if(places, has_cameras);
  if (taken == places.end())
    fail_in(folder, "no COLMAP model: no cameras.txt or cameras.bin in {}, {} or {}",
            places[0].string(), places[1].string(), places[2].string());
  if (const auto others = other_models(places, *taken); !others.empty())
    context.info("{}: this model is read; ignored: {}", taken->string(), fmt::join(others, ", "));
  return *taken;
}

ColmapModel read_colmap_model(const fs::path& folder, const Context& context) {
  const ModelForm form = model_form(folder);
  ColmapModel model;
  model.cameras = kCameras.read(folder, form, context);
  model.images = kImages.read(folder, form, context);
  model.points = kPoints.read(folder, form, context);
  const std::string where = folder.string();
  require_unique_ids(model.cameras, "camera", where);
  require_unique_ids(model.images, "image", where);
  require_unique_ids(model.points, "3D point", where);
  require_unique_names(model, where);
  check_references(model, where);
  warn_of_ignored_files(folder, form, model, context);
  warn_of_port_values(model.cameras, part_file(folder, "cameras", form).string(), context);
  return model;
}

std::vector<ColmapCamera> read_colmap_cameras(const fs::path& path, const Context& context) {
  if (is_calibmar(path)) {
    const std::vector<ColmapCamera> camera{read_calibmar(path, context)};
    warn_of_port_values(camera, path.string(), context);
    return camera;
  }
  std::error_code error;
  const bool is_folder = fs::is_directory(path, error);
  const ModelForm form = is_folder                    ? cameras_form(path)
                         : path.extension() == ".bin" ? ModelForm::binary
                                                      : ModelForm::text;
  const fs::path file = is_folder ? part_file(path, "cameras", form) : path;
  const std::vector<ColmapCamera> cameras = form == ModelForm::binary
                                                ? read_cameras_binary(file, context)
                                                : read_cameras_text(file, context);
  require_unique_ids(cameras, "camera", path.string());
  if (is_folder) warn_of_ignored_cameras(path, form, cameras, context);
  warn_of_port_values(cameras, file.string(), context);
  return cameras;
}

}  // namespace axial::io
