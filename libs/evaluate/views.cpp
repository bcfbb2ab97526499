// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/views.h"

#include <map>
#include <variant>

#include "base/error.h"
#include "base/parallel.h"
#include "io/colmap_lens.h"

namespace axial::evaluate {
namespace {

CameraModel dry_camera(const io::ColmapCamera& camera) {
  const auto lens = io::pinhole_lens(camera);
  CameraModel model;
  model.width = static_cast<int>(camera.width);
  model.height = static_cast<int>(camera.height);
  model.distortion = io::lens_distortion(camera);
  if (!lens && !model.distortion)
    fail("camera {} is {}: expected a lens that is matched as it is", camera.id, camera.model);
  model.lens = lens ? *lens : io::undistorted_lens(camera);
  if (model.distortion && !(distorted_lens<double>(model).field > 0))
    fail("camera {}: the distortion of its {} lens turns the image over", camera.id, camera.model);
  return model;
}

// `surface` null: nothing stands in between.
template <class Camera>
bool sees(const Camera& camera, const View& view, const Surface* surface,
          const Eigen::Vector3d& point) {
  const auto image = camera.project(view.pose.to_camera(point));
  const bool inside = image.visible && image.pixel.x() >= -0.5 && image.pixel.y() >= -0.5 &&
                      image.pixel.x() < view.camera.width - 0.5 &&
                      image.pixel.y() < view.camera.height - 0.5;
  return inside &&
         !(surface && surface->blocked(point, view.pose.to_world(camera.exit_point(image.pixel))));
}

std::vector<std::uint32_t> count(std::span<const Eigen::Vector3f> points,
                                 std::span<const View> views, const Surface* surface) {
  std::vector<std::uint32_t> counts(points.size(), 0);
  for (const View& view : views) {
    std::visit(
        [&](const auto& camera) {
          parallel_for(
              points.size(),
              [&](std::size_t i) {
                if (sees(camera, view, surface, points[i].cast<double>())) ++counts[i];
              },
              1024);
        },
        make_camera<double>(view.camera));
  }
  return counts;
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
      fail("image {} names camera {}, which the model does not have", image.name, image.camera);
    View view{image.name, camera->second, image.pose};
    if (housing)
      view.camera.port =
          housing->port_at(housing->port_of(image.name, image.camera), image.pose, image.name);
    views.push_back(std::move(view));
  }
  return views;
}

std::vector<std::uint32_t> count_views(std::span<const Eigen::Vector3f> points,
                                       std::span<const View> views, const Surface& surface) {
  return count(points, views, &surface);
}

std::vector<std::uint32_t> count_frames(std::span<const Eigen::Vector3f> points,
                                        std::span<const View> views) {
  return count(points, views, nullptr);
}

std::vector<Eigen::Vector3f> seen_points(std::span<const Eigen::Vector3f> points,
                                         std::span<const View> views, const Surface& surface,
                                         std::uint32_t least) {
  const std::vector<std::uint32_t> counts = count_views(points, views, surface);
  std::vector<Eigen::Vector3f> seen;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (counts[i] >= least) seen.push_back(points[i]);
  return seen;
}

}  // namespace axial::evaluate
