// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace axial {

// A dense cloud. Every array is empty or as long as `positions`; views are stored one behind the
// other, those of point i at [view_begin[i], view_begin[i + 1]).
struct PointCloud {
  std::vector<Eigen::Vector3f> positions;  // world frame
  std::vector<Eigen::Vector3f> normals;    // world frame, unit
  std::vector<Rgb> colors;
  std::vector<std::size_t> view_begin;     // empty, or size() + 1 entries
  std::vector<std::uint32_t> view_images;  // indices into Scene::images
  std::vector<float> view_weights;         // as view_images
  std::vector<float> errors;               // expected distance to the true surface [m]; 0: unknown
  std::vector<float> confidences;          // probability that 3 such errors are not exceeded

  std::size_t size() const { return positions.size(); }
  std::span<const std::uint32_t> views_of(std::size_t i) const {
    return std::span(view_images).subspan(view_begin[i], view_begin[i + 1] - view_begin[i]);
  }
};

}  // namespace axial
