// SPDX-License-Identifier: GPL-3.0-or-later
#include "belong/nearest_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "base/parallel.h"
#include "geometry/triangle_distance.h"

namespace axial::belong {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t i : cell)
      hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9E3779B97F4A7C15u + (hash >> 29);
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

// Some of the places in cubes whose side is the reach. A cube lists the places in it and in the 26
// cubes around it: all places that are within the reach of a point of the cube.
class PlaceGrid {
 public:
  explicit PlaceGrid(double reach) : reach_(reach) {}

  void add(std::uint32_t index, const Eigen::Vector3d& place) {
    all_.push_back(index);
    low_ = low_.cwiseMin(place);
    high_ = high_.cwiseMax(place);
    const Cell cell = cell_of(place);
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z)
          cells_[{cell[0] + x, cell[1] + y, cell[2] + z}].push_back(index);
  }

  // Calls visit(index) for all places that may be within the reach of the box, some of them several
  // times.
  template <class Visit>
  void near(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Visit& visit) const {
    if (((low - high_).array() > reach_).any() || ((low_ - high).array() > reach_).any()) return;
    const Cell first = cell_of(low), last = cell_of(high);
    double cells = 1;
    for (std::size_t k = 0; k < 3; ++k) cells *= static_cast<double>(last[k] - first[k] + 1);
    if (cells > static_cast<double>(all_.size())) return visit_all(all_, visit);
    for (std::int64_t x = first[0]; x <= last[0]; ++x)
      for (std::int64_t y = first[1]; y <= last[1]; ++y)
        for (std::int64_t z = first[2]; z <= last[2]; ++z)
          if (const auto found = cells_.find({x, y, z}); found != cells_.end())
            visit_all(found->second, visit);
  }

 private:
  template <class Visit>
  static void visit_all(const std::vector<std::uint32_t>& indices, const Visit& visit) {
    for (const std::uint32_t index : indices) visit(index);
  }

  Cell cell_of(const Eigen::Vector3d& place) const {
    constexpr double kFar = 1e15;  // exact in double, and far beyond all places
    Cell cell{};
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] = static_cast<std::int64_t>(
          std::clamp(std::floor(place[static_cast<Eigen::Index>(k)] / reach_), -kFar, kFar));
    return cell;
  }

  double reach_;
  Eigen::Vector3d low_ = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high_ = -low_;  // with low_, the box of the places
  std::vector<std::uint32_t> all_;
  std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> cells_;
};

struct Nearest {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double distance2 = 0;  // squared
};

// The corners of a part; of a point, three times the point.
std::array<Eigen::Vector3d, 3> corners_of(const Shape& shape, std::size_t part) {
  const auto at = [&](std::size_t i) { return Eigen::Vector3d(shape.vertices[i].cast<double>()); };
  if (shape.faces.empty()) return {at(part), at(part), at(part)};
  const auto& [a, b, c] = shape.faces[part];
  return {at(a), at(b), at(c)};
}

// The places, grouped by the distance up to which a nearer point is looked for.
std::vector<PlaceGrid> grids_of(std::span<const Eigen::Vector3d> places,
                                std::span<const Nearest> nearest, double reach) {
  constexpr int kGrids = 3;
  constexpr double kRatio = 5;  // of the reaches of two grids
  std::vector<PlaceGrid> grids;
  for (int k = 0; k < kGrids; ++k) grids.emplace_back(reach / std::pow(kRatio, k));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double steps = std::log(reach * reach / nearest[i].distance2) / (2 * std::log(kRatio));
    grids[static_cast<std::size_t>(std::clamp(std::floor(steps), 0.0, kGrids - 1.0))].add(
        static_cast<std::uint32_t>(i), places[i]);
  }
  return grids;
}

void search(const Shape& shape, std::size_t part, std::span<const PlaceGrid> grids,
            std::span<const Eigen::Vector3d> places, std::span<Nearest> nearest) {
  const std::array<Eigen::Vector3d, 3> corners = corners_of(shape, part);
  const Eigen::Vector3d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Eigen::Vector3d high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  const auto visit = [&](std::uint32_t i) {
    const Eigen::Vector3d& place = places[i];
    const Eigen::Vector3d in_box = place.cwiseMax(low).cwiseMin(high);
    if ((in_box - place).squaredNorm() >= nearest[i].distance2) return;
    const Eigen::Vector3d point =
        shape.faces.empty() ? corners[0] : geometry::closest_on_triangle(place, corners);
    const double distance2 = (point - place).squaredNorm();
    if (distance2 < nearest[i].distance2) nearest[i] = {point, distance2};
  };
  for (const PlaceGrid& grid : grids) grid.near(low, high, visit);
}

// Looks for nearer points than `nearest` on each `step`-th part.
void search_parts(const Shape& shape, std::size_t step, std::span<const Eigen::Vector3d> places,
                  double reach, std::vector<Nearest>& nearest) {
  constexpr std::size_t kPortions = 16;  // each has its own results, which are then joined in order
  const std::vector<PlaceGrid> grids = grids_of(places, nearest, reach);
  std::vector<std::vector<Nearest>> found(kPortions, nearest);
  const std::size_t steps = (shape.parts() + step - 1) / step;
  parallel_for(kPortions, [&](std::size_t portion) {
    const std::size_t end = steps * (portion + 1) / kPortions;
    for (std::size_t k = steps * portion / kPortions; k < end; ++k)
      search(shape, k * step, grids, places, found[portion]);
  });
  for (const std::vector<Nearest>& portion : found)
    for (std::size_t i = 0; i < places.size(); ++i)
      if (portion[i].distance2 < nearest[i].distance2) nearest[i] = portion[i];
}

}  // namespace

std::vector<std::optional<Eigen::Vector3d>> nearest_places(const Shape& shape,
                                                           std::span<const Eigen::Vector3d> places,
                                                           double reach) {
  std::vector<Nearest> nearest(places.size(), {Eigen::Vector3d::Zero(), reach * reach});
  // A sample of the parts gives most places a point that is near, so that few parts are within the
  // distance of any place when all parts are searched.
  constexpr std::size_t kSample = 16;
  if (shape.parts() > kSample) search_parts(shape, kSample, places, reach, nearest);
  search_parts(shape, 1, places, reach, nearest);
  std::vector<std::optional<Eigen::Vector3d>> result(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    if (nearest[i].distance2 < reach * reach) result[i] = nearest[i].point;
  return result;
}

}  // namespace axial::belong
