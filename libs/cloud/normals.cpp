// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/normals.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/point_tree.h"
#include "scene/decompositions.h"

namespace axial::cloud {
namespace {

Eigen::Vector3d smallest_component(const std::vector<Eigen::Vector3f>& points,
                                   std::span<const std::uint32_t> chosen) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : chosen) mean += points[i].cast<double>();
  mean /= static_cast<double>(chosen.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : chosen) {
    const Eigen::Vector3d d = points[i].cast<double>() - mean;
    covariance += d * d.transpose();
  }
  SymmetricEigen3 solver;
  solver.computeDirect(covariance);
  return solver.eigenvectors().col(0);
}

Eigen::Vector3d mean_camera(const Scene& scene) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (const SceneImage& image : scene.images) {
    if (!image.calibrated) continue;
    sum += image.pose.centre;
    ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : sum;
}

}  // namespace

void estimate_normals(PointCloud& cloud, const Scene& scene, std::size_t neighbours) {
  const bool has_views = cloud.view_begin.size() == cloud.size() + 1;
  for (const std::uint32_t image : cloud.view_images) {
    if (image >= scene.images.size()) {
      fail("cloud: refers to image {}, but there are {} images", image, scene.images.size());
    }
  }
  cloud.normals.assign(cloud.size(), Eigen::Vector3f(0, 0, 1));
  if (cloud.size() == 0) return;
  const geometry::PointSet positions{cloud.positions};
  const geometry::PointTree<> tree(3, positions, {10});
  const std::size_t count = std::min(std::max<std::size_t>(neighbours, 3), cloud.size());
  const Eigen::Vector3d middle = mean_camera(scene);
  parallel_for(
      cloud.size(),
      [&](std::size_t i) {
        const Eigen::Vector3f& point = cloud.positions[i];
        const bool seen = has_views && !cloud.views_of(i).empty();
        const Eigen::Vector3d camera =
            seen ? scene.images[cloud.views_of(i).front()].pose.centre : middle;
        const Eigen::Vector3d to_camera = camera - point.cast<double>();
        Eigen::Vector3d normal = to_camera.stableNormalized();
        if (count >= 3) {
          std::vector<std::uint32_t> chosen(count);
          std::vector<float> distances(count);
          tree.knnSearch(point.data(), count, chosen.data(), distances.data());
          normal = smallest_component(cloud.positions, chosen);
          if (normal.dot(to_camera) < 0) normal = -normal;
        }
        cloud.normals[i] = normal.cast<float>();
      },
      kPointGrain);
}

}  // namespace axial::cloud
