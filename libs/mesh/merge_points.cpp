// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/merge_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "geometry/point_tree.h"

namespace axial::mesh {
namespace {

// Indices of the points, those with the most views first.
std::vector<std::uint32_t> by_views(const PointCloud& cloud) {
  std::vector<std::uint32_t> order(cloud.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return cloud.views_of(a).size() > cloud.views_of(b).size();
  });
  return order;
}

class Merger {
 public:
  Merger(const PointCloud& cloud, const ViewRays& rays, double min_distance)
      : cloud_(cloud),
        rays_(rays),
        limit_(static_cast<float>(min_distance)),
        set_{cloud.positions},
        tree_(3, set_, {16}),
        used_(cloud.size(), false) {}

  // Merges point i with its neighbours, unless i is merged already. Appends the result if there is
  // room for it.
  void take_point(std::uint32_t i, std::size_t most, MergedPoints& result) {
    if (used_[i]) return;
    const float sharpest = find_motions(i);
    if (!(sharpest > 0)) return;
    sum_.setZero();
    weights_ = 0;
    views_.clear();
    find_neighbours(i, 2 * limit_ / sharpest);
    for (const auto& [k, distance2] : found_) absorb(i, k);
    absorb(i, i);
    if (++result.count > most) {
      const std::size_t count = result.count;
      result = {};
      result.count = count;
      return;
    }
    result.positions.emplace_back(cloud_.positions[i] + sum_ / weights_);
    result.pixel_widths.push_back(1 / sharpest);
    for (const auto& [view, weight] : views_) {
      result.view_images.push_back(view);
      result.view_weights.push_back(weight);
    }
    result.view_begin.push_back(result.view_images.size());
  }

 private:
  // Finds how the pixels of the point move in its views. Returns the largest resolution [px/m].
  float find_motions(std::uint32_t i) {
    motions_.clear();
    float sharpest = 0;
    for (const std::uint32_t view : cloud_.views_of(i)) {
      motions_.push_back(rays_.pixel_motion(view, cloud_.positions[i]));
      sharpest = std::max(sharpest, motions_.back().norm() * std::sqrt(0.5f));
    }
    return sharpest;
  }

  // Finds the points that point i absorbs, all within `radius`, the nearest first.
  void find_neighbours(std::uint32_t i, float radius) {
    found_.clear();
    nanoflann::SearchParams params;
    params.sorted = false;
    if (limit_ > 0) tree_.radiusSearch(cloud_.positions[i].data(), radius * radius, found_, params);
    std::erase_if(found_, [&](const auto& found) {
      return found.first == i || used_[found.first] || !is_near(i, found.first);
    });
    std::sort(found_.begin(), found_.end(), [](const auto& a, const auto& b) {
      return std::pair(a.second, a.first) < std::pair(b.second, b.first);
    });
  }

  bool is_near(std::uint32_t i, std::uint32_t k) const {
    constexpr float kLeastCosine = 0.5f;  // 60 degrees
    if (!cloud_.normals.empty() && cloud_.normals[k].dot(cloud_.normals[i]) < kLeastCosine)
      return false;
    const Eigen::Vector3f step = cloud_.positions[k] - cloud_.positions[i];
    return std::ranges::all_of(motions_, [&](const auto& motion) {
      return (motion * step).squaredNorm() <= limit_ * limit_;
    });
  }

  void absorb(std::uint32_t i, std::uint32_t k) {
    used_[k] = true;
    float weight = 0;
    for (std::size_t v = cloud_.view_begin[k]; v < cloud_.view_begin[k + 1]; ++v) {
      views_[cloud_.view_images[v]] += 1;
      weight += cloud_.view_weights.empty() ? 1 : std::max(cloud_.view_weights[v], 1e-6f);
    }
    if (weight == 0) weight = 1e-6f;  // a neighbour without views
    sum_ += weight * (cloud_.positions[k] - cloud_.positions[i]);
    weights_ += weight;
  }

  const PointCloud& cloud_;
  const ViewRays& rays_;
  float limit_;  // [px]
  geometry::PointSet set_;
  geometry::PointTree<> tree_;
  std::vector<bool> used_;
  // Of the current point.
  std::vector<Eigen::Matrix<float, 2, 3>> motions_;
  std::vector<std::pair<std::uint32_t, float>> found_;
  std::map<std::uint32_t, float> views_;
  Eigen::Vector3f sum_;
  float weights_ = 0;
};

MergedPoints in_order(const MergedPoints& points, std::span<const std::uint32_t> order) {
  MergedPoints result;
  result.count = points.count;
  result.positions.reserve(points.size());
  result.view_images.reserve(points.view_images.size());
  result.view_weights.reserve(points.view_images.size());
  for (const std::uint32_t i : order) {
    result.positions.push_back(points.positions[i]);
    result.pixel_widths.push_back(points.pixel_widths[i]);
    for (std::size_t v = points.view_begin[i]; v < points.view_begin[i + 1]; ++v) {
      result.view_images.push_back(points.view_images[v]);
      result.view_weights.push_back(points.view_weights[v]);
    }
    result.view_begin.push_back(result.view_images.size());
  }
  return result;
}

// Moves the lowest 21 bits of x apart, with two zeros between neighbouring bits.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffull;
  x = (x | x << 16) & 0x1f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

}  // namespace

MergedPoints merge_points(const PointCloud& cloud, const ViewRays& rays,
                          const MergeOptions& options) {
  MergedPoints merged;
  Merger merger(cloud, rays, options.min_distance);
  const std::size_t most =
      options.most_points > 0 ? options.most_points : std::numeric_limits<std::size_t>::max();
  for (const std::uint32_t i : by_views(cloud)) merger.take_point(i, most, merged);
  if (merged.count > most) return merged;
  sort_in_space(merged);
  return merged;
}

void sort_in_space(MergedPoints& points) {
  points = in_order(points, spatial_order(points.positions));
}

std::vector<std::uint32_t> spatial_order(std::span<const Eigen::Vector3f> points) {
  if (points.empty()) return {};
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& point : points) box.extend(point);
  const Eigen::Vector3d origin = box.min().cast<double>();
  const double side = (box.max().cast<double>() - origin).maxCoeff();
  const double scale = side > 0 ? 2097151 / side : 0;  // 2^21 - 1 cells
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  keys.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d cell = (point.cast<double>() - origin) * scale;
    keys.emplace_back(spread(static_cast<std::uint64_t>(cell.x())) |
                          spread(static_cast<std::uint64_t>(cell.y())) << 1 |
                          spread(static_cast<std::uint64_t>(cell.z())) << 2,
                      static_cast<std::uint32_t>(keys.size()));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const auto& [key, index] : keys) order.push_back(index);
  return order;
}

}  // namespace axial::mesh
