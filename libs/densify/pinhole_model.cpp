// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/pinhole_model.h"

#include <array>

#include "base/atomic_file.h"
#include "geometry/posed_camera.h"
#include "io/colmap/colmap.h"
#include "io/colmap/colmap_export.h"
#include "io/openmvs/mvs_counts.h"

namespace axial::densify {

std::uint64_t bytes_of_pinhole_points(const Scene& scene) {
  constexpr std::uint64_t kSeen = 8, kImage = sizeof(std::vector<int>);
  return kSeen * io::count_scene(scene).observations + kImage * scene.images.size();
}

std::uint64_t bytes_needed_for_pinhole_model(const Scene& scene) {
  // For a point: the point of the scene and that of the model, whose vector grows, and its lists.
  // For an observation: the view, the projection, the two entries of the model, in vectors that
  // grow, and the bytes of the file.
  constexpr std::uint64_t kPoint = 400, kObservation = 320;
  const io::MvsCounts counts = io::count_scene(scene);
  return kPoint * counts.points + kObservation * counts.observations;
}

PinholePoints::PinholePoints(const Scene& scene, std::span<const std::size_t> images)
    : scene_(scene), of_image_(scene.images.size()) {
  static_assert(sizeof(Seen) == 8);
  std::vector<std::size_t> counts(scene.images.size());
  for (const SparsePoint& point : scene.points)
    for (const SparseView& view : point.views) ++counts[view.image];
  std::vector<bool> is_wanted(scene.images.size(), false);
  for (const std::size_t image : images) {
    is_wanted[image] = true;
    of_image_[image].reserve(counts[image]);
  }
  for (std::uint32_t p = 0; p < scene.points.size(); ++p)
    for (const SparseView& view : scene.points[p].views) {
      std::vector<Seen>& seen = of_image_[view.image];
      const bool repeated = !seen.empty() && seen.back().point == p;
      if (is_wanted[view.image] && !repeated) seen.push_back({p});
    }
}

void PinholePoints::find(std::size_t image, const cloud::PinholeView& view,
                         const cloud::PinholeImage& picture) {
  const Pose pose = view.pose(scene_.images[image].pose);
  const cv::Rect inside({}, picture.label.size());
  for (Seen& seen : of_image_[image]) {
    const Eigen::Vector3d x =
        pose.to_camera(scene_.points[seen.point].position.template cast<double>());
    if (x.z() <= 0) continue;
    const Eigen::Vector2d pixel = view.camera.lens.pixel(x);
    if (!geometry::is_in_image(view.camera, pixel, -0.5)) continue;
    const cv::Point at(cvRound(pixel.x()), cvRound(pixel.y()));
    if (!inside.contains(at)) continue;
    seen.shown = picture.usable(at) != 0;
    const cv::Vec3b& color = picture.color(at);
    seen.color = {color[2], color[1], color[0]};
  }
}

void PinholePoints::give_to(Scene& exported) const {
  const std::size_t count = scene_.points.size();
  std::vector<std::array<std::uint32_t, 3>> sums(count);
  exported.points.resize(count);
  for (std::size_t i = 0; i < of_image_.size(); ++i)
    for (const Seen& seen : of_image_[i]) {
      if (!seen.shown) continue;
      exported.points[seen.point].views.push_back({static_cast<std::uint32_t>(i)});
      for (std::size_t k = 0; k < 3; ++k) sums[seen.point][k] += seen.color[k];
    }
  exported.point_colors.assign(count, {});
  for (std::size_t p = 0; p < count; ++p) {
    exported.points[p].position = scene_.points[p].position;
    const auto views = static_cast<std::uint32_t>(exported.points[p].views.size());
    for (std::size_t k = 0; views > 0 && k < 3; ++k)
      exported.point_colors[p][k] = static_cast<std::uint8_t>((sums[p][k] + views / 2) / views);
  }
}

PinholeModelSize write_pinhole_model(const std::filesystem::path& folder, const Scene& scene,
                                     const std::filesystem::path& images) {
  const io::ColmapModel model = io::export_colmap_model(scene, images);
  make_folder(folder);
  io::write_colmap_binary(folder, model);
  return {model.images.size(), model.points.size()};
}

}  // namespace axial::densify
