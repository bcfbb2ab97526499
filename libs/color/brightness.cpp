// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/brightness.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/order_statistics.h"

namespace axial::color {
namespace {

// The light of an observation, as a share of the mean restored light of its point. NaN in channels
// that are not determined or not known.
struct Share {
  float way;
  Eigen::Vector2f place;
  Eigen::Array3f before, after;
};

void add_shares(std::span<const Observation> seen, const WaterModel& model,
                std::vector<Share>& shares) {
  if (seen.size() < 2) return;
  const std::array<bool, 3> known = determined(model);
  std::vector<Eigen::Array3f> restored;
  Eigen::Array3f mean = Eigen::Array3f::Zero();
  for (const Observation& one : seen) {
    restored.push_back(surface_light(model, one.sight, one.light));
    mean += restored.back() / static_cast<float>(seen.size());
  }
  for (Eigen::Index k = 0; k < 3; ++k)
    if (!known[static_cast<std::size_t>(k)] || !(mean[k] > 0)) mean[k] = std::nanf("");
  for (std::size_t i = 0; i < seen.size(); ++i)
    shares.push_back(
        {seen[i].sight.way, seen[i].sight.place, seen[i].light / mean, restored[i] / mean});
}

std::vector<Share> shares_of(const Observations& observations, const WaterModel& model) {
  std::vector<Share> shares;
  for (std::size_t point = 0; point < observations.points(); ++point)
    add_shares(observations.of(point), model, shares);
  return shares;
}

Eigen::Array3f median_of(std::span<const Share> shares, Eigen::Array3f Share::*part) {
  Eigen::Array3f median;
  for (int k = 0; k < 3; ++k) {
    std::vector<float> values;
    for (const Share& share : shares)
      if (const float value = (share.*part)[k]; std::isfinite(value)) values.push_back(value);
    median[k] = upper_median(std::move(values));
  }
  return median;
}

}  // namespace

std::vector<BrightnessAt> brightness_by_way(const Observations& observations,
                                            const WaterModel& model) {
  constexpr std::size_t kLayers = 12, kLeastInLayer = 20;
  std::vector<Share> shares = shares_of(observations, model);
  std::ranges::stable_sort(shares, {}, &Share::way);
  std::vector<BrightnessAt> layers;
  if (shares.size() < kLayers * kLeastInLayer) return layers;
  for (std::size_t layer = 0; layer < kLayers; ++layer) {
    const std::size_t begin = layer * shares.size() / kLayers;
    const std::size_t end = (layer + 1) * shares.size() / kLayers;
    const std::span<const Share> part = std::span(shares).subspan(begin, end - begin);
    layers.push_back({part[part.size() / 2].way, median_of(part, &Share::before),
                      median_of(part, &Share::after)});
  }
  return layers;
}

double unevenness_by_place(const Observations& observations, const WaterModel& model) {
  constexpr int kAcross = 8, kDown = 6;
  constexpr std::size_t kLeastInCell = 20;
  std::array<std::vector<float>, kAcross * kDown> cells;
  const std::vector<Share> shares = shares_of(without_shadows(observations), model);
  float half_height = 1e-3f;
  for (const Share& share : shares) half_height = std::max(half_height, std::abs(share.place.y()));
  const auto cell_of = [](float from_middle, int count) {
    return std::clamp(static_cast<int>((from_middle + 1) / 2 * static_cast<float>(count)), 0,
                      count - 1);
  };
  for (const Share& share : shares) {
    const int cell =
        cell_of(share.place.y() / half_height, kDown) * kAcross + cell_of(share.place.x(), kAcross);
    for (const float after : share.after) {
      if (after > 0) cells[static_cast<std::size_t>(cell)].push_back(std::log(after));
    }
  }
  std::vector<float> levels;
  for (std::vector<float>& cell : cells)
    if (cell.size() >= kLeastInCell) levels.push_back(upper_median(std::move(cell)));
  const float middle = upper_median(levels);
  double squares = 0;
  for (const float level : levels) squares += std::pow(level - middle, 2);
  return levels.empty() ? 0 : std::sqrt(squares / static_cast<double>(levels.size()));
}

}  // namespace axial::color
