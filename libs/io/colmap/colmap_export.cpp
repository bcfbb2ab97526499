// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap_export.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/error.h"
#include "colmap/private/colmap_parts.h"
#include "lens/models.h"
#include "scene/camera_model.h"

namespace axial::io {
namespace fs = std::filesystem;

namespace {

constexpr double kHalf = 0.5;  // COLMAP's pixel centres

// Cameras with equal keys become one COLMAP camera.
std::vector<double> key_of(const CameraModel& camera) {
  const auto& lens = camera.lens;
  std::vector<double> key{static_cast<double>(camera.width),
                          static_cast<double>(camera.height),
                          lens.fx,
                          lens.fy,
                          lens.cx,
                          lens.cy};
  if (auto distortion = camera.distortion)
    distortion->each_field([&](double number) { key.push_back(number); });
  if (!camera.port) return key;
  key.push_back(static_cast<double>(camera.port->index()));
  const PortNumbers port = port_numbers(*camera.port);
  key.insert(key.end(), port.begin(), port.end());
  return key;
}

// The camera without its id. Error that starts with `path` for a lens that COLMAP has no model of.
ColmapCamera colmap_camera(const CameraModel& model, const std::string& path) {
  lens::ModelOf form{"PINHOLE", {}};
  if (model.distortion) {
    const auto found = lens::model_of(*model.distortion);
    if (!found)
      fail_in(path, "no camera model of COLMAP describes its lens: undistort the images on import");
    form = *found;
  }
  ColmapCamera camera;
  camera.model = form.name;
  camera.width = static_cast<std::uint64_t>(model.width);
  camera.height = static_cast<std::uint64_t>(model.height);
  camera.params = {form.focal_factor * model.lens.fx, form.focal_factor * model.lens.fy,
                   model.lens.cx + kHalf, model.lens.cy + kHalf};
  camera.params.insert(camera.params.end(), form.parameters.begin(), form.parameters.end());
  camera.port = model.port;
  return camera;
}

class Cameras {
 public:
  explicit Cameras(std::vector<ColmapCamera>& cameras) : cameras_(cameras) {}

  std::uint32_t id_of(const SceneImage& image) {
    const auto next = static_cast<std::uint32_t>(cameras_.size() + 1);
    const auto [entry, is_new] = ids_.emplace(key_of(image.camera), next);
    if (is_new) {
      cameras_.push_back(colmap_camera(image.camera, image.path));
      cameras_.back().id = next;
    }
    return entry->second;
  }

 private:
  std::vector<ColmapCamera>& cameras_;
  std::map<std::vector<double>, std::uint32_t> ids_;
};

std::string name_below(const SceneImage& image, const fs::path& folder) {
  const fs::path name = fs::path(image.path).lexically_normal().lexically_relative(folder);
  if (name.empty() || *name.begin() == ".." || *name.begin() == ".")
    fail_in(image.path, "is not in the image folder {}", folder.string());
  return name.generic_string();
}

// The projection of a point into one image; `seen` is false where the camera does not see it.
struct ProjectedPoint {
  std::uint32_t image = 0;
  Eigen::Vector2d pixel{0, 0};
  bool seen = false;
};

std::vector<std::vector<ProjectedPoint>> projected_points(const Scene& scene) {
  std::vector<std::vector<ProjectedPoint>> result(scene.points.size());
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> of_image(scene.images.size());
  for (std::size_t p = 0; p < scene.points.size(); ++p) {
    std::uint32_t previous = kNoId;
    for (const SparseView& view : scene.points[p].views) {
      if (view.image == previous || !scene.images[view.image].calibrated) continue;
      previous = view.image;
      of_image[view.image].emplace_back(p, result[p].size());
      result[p].push_back({view.image});
    }
  }
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    if (of_image[i].empty()) continue;
    const SceneImage& image = scene.images[i];
    std::visit(
        [&](const auto& camera) {
          for (const auto& [point, index] : of_image[i]) {
            const Eigen::Vector3d X = scene.points[point].position.template cast<double>();
            const auto projection = camera.project(image.pose.to_camera(X));
            ProjectedPoint& projected = result[point][index];
            projected.pixel = projection.pixel;
            projected.seen = projection.visible;
          }
        },
        make_camera<double>(image.camera));
  }
  return result;
}

void add_points(const Scene& scene, const std::vector<std::size_t>& index_of, ColmapModel& model) {
  const auto all = projected_points(scene);
  for (std::size_t p = 0; p < scene.points.size(); ++p) {
    ColmapPoint3D point;
    point.id = model.points.size() + 1;
    point.position = scene.points[p].position.cast<double>();
    if (!scene.point_colors.empty()) point.color = scene.point_colors[p];
    for (const ProjectedPoint& projected : all[p]) {
      if (!projected.seen) continue;
      ColmapImage& image = model.images[index_of[projected.image]];
      point.track.push_back({image.id, static_cast<std::uint32_t>(image.points.size())});
      image.points.push_back({projected.pixel.x() + kHalf, projected.pixel.y() + kHalf, point.id});
    }
    if (!point.track.empty()) model.points.push_back(std::move(point));
  }
}

}  // namespace

ColmapModel export_colmap_model(const Scene& scene, const fs::path& image_folder) {
  ColmapModel model;
  Cameras cameras(model.cameras);
  std::vector<std::size_t> index_of(scene.images.size(), 0);
  std::set<std::string> names;
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const SceneImage& image = scene.images[i];
    if (!image.calibrated) continue;
    index_of[i] = model.images.size();
    ColmapImage exported;
    exported.id = image.id + 1;
    exported.camera = cameras.id_of(image);
    exported.name = name_below(image, image_folder);
    exported.pose = image.pose;
    if (!names.insert(exported.name).second) fail_in(image.path, "two images have this path");
    model.images.push_back(std::move(exported));
  }
  add_points(scene, index_of, model);
  return model;
}

fs::path common_image_folder(const Scene& scene) {
  fs::path common;
  bool first = true;
  for (const SceneImage& image : scene.images) {
    if (!image.calibrated) continue;
    const fs::path folder = fs::path(image.path).lexically_normal().parent_path();
    if (first) common = folder;
    first = false;
    fs::path shared;
    auto a = common.begin(), b = folder.begin();
    for (; a != common.end() && b != folder.end() && *a == *b; ++a, ++b) shared /= *a;
    common = shared;
  }
  return common;
}

}  // namespace axial::io
