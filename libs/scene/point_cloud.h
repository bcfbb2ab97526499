// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace axial {

// A dense point cloud. An array is empty or as long as `positions`, unless the comment on the array
// says otherwise. The views of all points are stored in one array: the views of point i have the
// indices [view_begin[i], view_begin[i + 1]).
struct PointCloud {
  std::vector<Eigen::Vector3f> positions;  // world frame
  std::vector<Eigen::Vector3f> normals;    // world frame, unit
  std::vector<Rgb> colors;
  std::vector<std::size_t> view_begin;     // empty, or size() + 1 entries
  std::vector<std::uint32_t> view_images;  // indices into Scene::images
  std::vector<float> view_weights;         // empty, or one per entry of view_images
  std::vector<float> errors;               // expected distance to the true surface [m]; 0: unknown
  std::vector<float> confidences;          // probability that the distance is at most 3 * error

  std::size_t size() const { return positions.size(); }
  // The images that see point i. Precondition: view_begin is not empty.
  std::span<const std::uint32_t> views_of(std::size_t i) const {
    return std::span(view_images).subspan(view_begin[i], view_begin[i + 1] - view_begin[i]);
  }
};

// The sparse points of `scene` as a cloud, in the order of Scene::points, with their views, and
// with normals and colours if `scene` has them. The weight of a view is its SparseView::confidence.
// `errors` and `confidences` are empty.
PointCloud cloud_of(const Scene& scene);

}  // namespace axial
