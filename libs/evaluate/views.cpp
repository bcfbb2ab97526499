// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/views.h"

#include <cmath>
#include <map>
#include <variant>

#include "base/error.h"
#include "base/parallel.h"
#include "io/colmap/colmap_lens.h"
#include "lens/lens.h"

namespace axial::evaluate {
namespace {

CameraModel dry_camera(const io::ColmapCamera& camera) {
  const lens::Lens in_air = io::lens_of(camera);
  const bool distorted = !pinhole_lens(in_air);
  CameraModel model;
  model.width = static_cast<int>(camera.width);
  model.height = static_cast<int>(camera.height);
  model.distortion = lens_distortion(in_air);
  if (distorted && !model.distortion)
    fail("camera {}: its model {} needs undistortion, which is not done here", camera.id,
         camera.model);
  model.lens = in_air.pinhole;
  if (model.distortion && !(distorted_lens<double>(model).field > 0))
    fail("camera {}: the distortion of its {} lens mirrors the image", camera.id, camera.model);
  return model;
}

// `surface` may be null: nothing occludes the point.
template <class Camera>
bool sees(const Camera& camera, const View& view, const geometry::Surface* surface,
          const Eigen::Vector3d& point) {
  const auto image = camera.project(view.pose.to_camera(point));
  const bool inside = image.visible && image.pixel.x() >= -0.5 && image.pixel.y() >= -0.5 &&
                      image.pixel.x() < view.camera.width - 0.5 &&
                      image.pixel.y() < view.camera.height - 0.5;
  if (!inside || !surface) return inside;
  return !surface->between(point, view.pose.to_world(camera.exit_point(image.pixel)), 1e-4, 0);
}

// Calls visit(i, camera, view) for every point and every view that sees it, one view after the
// other, concurrently for different points. `surface` may be null: nothing occludes the points.
template <class Visit>
void for_each_sight(std::span<const Eigen::Vector3f> points, std::span<const View> views,
                    const geometry::Surface* surface, const Visit& visit) {
  for (const View& view : views) {
    std::visit(
        [&](const auto& camera) {
          parallel_for(
              points.size(),
              [&](std::size_t i) {
                if (sees(camera, view, surface, points[i].cast<double>())) visit(i, camera, view);
              },
              1024);
        },
        make_camera<double>(view.camera));
  }
}

std::vector<std::uint32_t> count(std::span<const Eigen::Vector3f> points,
                                 std::span<const View> views, const geometry::Surface* surface) {
  std::vector<std::uint32_t> counts(points.size(), 0);
  for_each_sight(points, views, surface,
                 [&](std::size_t i, const auto&, const View&) { ++counts[i]; });
  return counts;
}

// The width of a pixel at a point that the camera sees: the motion across the ray that moves the
// image by one pixel, as the geometric mean over directions.
template <class Camera>
double pixel_width(const Camera& camera, const Eigen::Vector3d& in_camera) {
  Eigen::Matrix<double, 2, 3> jacobian;
  camera.project(in_camera, &jacobian);
  return 1 / std::sqrt(std::sqrt((jacobian * jacobian.transpose()).determinant()));
}

}  // namespace

std::vector<View> views_of_model(const io::ColmapModel& model, const io::Housing* housing) {
  if (model.images.empty()) fail("the model has no images");
  std::map<std::uint32_t, CameraModel> cameras;
  for (const io::ColmapCamera& camera : model.cameras) cameras[camera.id] = dry_camera(camera);
  std::vector<View> views;
  for (const io::ColmapImage& image : model.images) {
    const auto camera = cameras.find(image.camera);
    if (camera == cameras.end())
      fail("image {} refers to camera {}, which the model does not have", image.name, image.camera);
    View view{{camera->second, image.pose}, image.name};
    if (housing)
      view.camera.port =
          housing->port_at(housing->port_of(image.name, image.camera), image.pose, image.name);
    views.push_back(std::move(view));
  }
  return views;
}

std::vector<std::uint32_t> count_views(std::span<const Eigen::Vector3f> points,
                                       std::span<const View> views,
                                       const geometry::Surface& surface) {
  return count(points, views, &surface);
}

std::vector<std::uint32_t> count_frames(std::span<const Eigen::Vector3f> points,
                                        std::span<const View> views) {
  return count(points, views, nullptr);
}

std::vector<float> pixel_widths(std::span<const Eigen::Vector3f> points,
                                std::span<const View> views, const geometry::Surface& surface) {
  std::vector<double> sums(points.size(), 0);
  std::vector<std::uint32_t> counts(points.size(), 0);
  for_each_sight(points, views, &surface, [&](std::size_t i, const auto& camera, const View& view) {
    sums[i] += pixel_width(camera, view.pose.to_camera(points[i].cast<double>()));
    ++counts[i];
  });
  std::vector<float> widths(points.size());
  for (std::size_t i = 0; i < widths.size(); ++i)
    widths[i] = counts[i] > 0 ? static_cast<float>(sums[i] / counts[i]) : 0.0f;
  return widths;
}

}  // namespace axial::evaluate
