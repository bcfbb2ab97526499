// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/two_views.h"

#include <cmath>

namespace axial::cloud {
namespace {

constexpr int kReach = 2;
constexpr int kLeastAgreeing = 5;
constexpr int kMostDiffering = 1;

}  // namespace

std::optional<std::size_t> only_witness(std::span<const std::vector<Answer>> answers,
                                        std::size_t i) {
  std::optional<std::size_t> witness;
  for (std::size_t n = 0; n < answers.size(); ++n) {
    const Answer answer = answers[n][i];
    if (answer.cannot_see()) continue;
    if (witness || !answer.names_pixel() || !answer.agrees()) return {};
    witness = n;
  }
  return witness;
}

bool in_surface(const FusionMap& map, std::uint32_t pixel, float max_difference) {
  const int x = static_cast<int>(pixel) % map.depth.cols;
  const int y = static_cast<int>(pixel) / map.depth.cols;
  const float depth = map.depth(y, x);
  int agreeing = 0, differing = 0;
  for (int dy = -kReach; dy <= kReach; dy += kReach)
    for (int dx = -kReach; dx <= kReach; dx += kReach) {
      const int u = x + dx, v = y + dy;
      if ((dx == 0 && dy == 0) || u < 0 || v < 0 || u >= map.depth.cols || v >= map.depth.rows)
        continue;
      const float other = map.depth(v, u);
      if (!(other > 0)) continue;
      ++(std::abs(other - depth) < max_difference * depth ? agreeing : differing);
    }
  return agreeing >= kLeastAgreeing && differing <= kMostDiffering;
}

}  // namespace axial::cloud
