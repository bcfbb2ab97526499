// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/weak_support.h"

#include <algorithm>
#include <limits>

#include "mesh/votes.h"

namespace axial::mesh {

WeakSupport::WeakSupport(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                         const Stars& stars, const Votes& votes)
    : tetrahedra_(tetrahedra), points_(points), stars_(stars) {
  support_.reserve(tetrahedra.size());
  for (const auto& facets : votes.facets) {
    double sum = 0;
    for (const std::int32_t cost : facets) sum += cost;
    support_.push_back(static_cast<float>(sum / kVoteScale));
  }
}

std::pair<std::uint32_t, double> WeakSupport::gain(std::uint32_t start,
                                                   const Eigen::Vector3d& direction,
                                                   double sigma) const {
  const auto support_of = [&](std::uint32_t cell) { return static_cast<double>(support_[cell]); };
  double before = 0;
  const std::uint32_t end =
      walk(tetrahedra_, points_, stars_, start, direction, 3 * sigma,
           [&](const Crossing& crossing) { before = std::max(before, support_of(crossing.from)); });
  if (end == Tetrahedra::kInfinity) return {end, 0};
  before = std::max(before, support_of(end));
  double least = std::numeric_limits<double>::infinity(), most = 0;
  const auto look_at = [&](std::uint32_t cell) {
    least = std::min(least, support_of(cell));
    most = std::max(most, support_of(cell));
  };
  const std::uint32_t last = walk(tetrahedra_, points_, stars_, start, -direction, 4 * sigma,
                                  [&](const Crossing& crossing) { look_at(crossing.from); });
  look_at(last);
  if (!(before > 0)) return {last, 0};
  // The published thresholds.
  constexpr double kSteepest = 0.1, kLeastFall = 1000, kMostBehind = 400;
  const double behind = (least + most) / 2;
  const bool steep =
      behind / before < kSteepest && before - behind > kLeastFall && behind < kMostBehind;
  return {last, steep ? before - behind : 0};
}

}  // namespace axial::mesh
