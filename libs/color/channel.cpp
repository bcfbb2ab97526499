// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/channel.h"

#include <algorithm>
#include <cmath>

#include "base/order_statistics.h"

namespace axial::color {

Channel channel_of(const Observations& observations, int k, const Transfer& transfer) {
  constexpr float kGreyLevel = 1 / 255.0f;
  Channel channel;
  channel.first.push_back(0);
  for (std::size_t point = 0; point < observations.points(); ++point) {
    std::vector<const Observation*> seen;
    float light = 0;
    for (const Observation& one : observations.of(point)) {
      if (!std::isfinite(one.light[k])) continue;
      seen.push_back(&one);
      light += one.light[k];
    }
    if (seen.size() < 2) continue;
    light /= static_cast<float>(seen.size());
    const float noise = kGreyLevel * transfer.slope(transfer.value(light));
    for (const Observation* one : seen) {
      channel.light.push_back(one->light[k]);
      channel.noise.push_back(noise);
      channel.spread.push_back(one->spread[k]);
      channel.sights.push_back(one->sight);
      channel.views.push_back(one->view);
    }
    channel.first.push_back(channel.light.size());
  }
  channel.sigma.resize(channel.light.size());
  channel.weight.resize(channel.light.size());
  std::vector<double> means(channel.points(), 0);
  for (std::size_t point = 0; point < channel.points(); ++point) {
    const std::size_t begin = channel.first[point], end = channel.first[point + 1];
    for (std::size_t i = begin; i < end; ++i)
      means[point] += channel.light[i] / static_cast<double>(end - begin);
  }
  expect(channel, std::vector<double>(channel.light.size(), 1), means);
  return channel;
}

Channel part_of(const Channel& channel, std::size_t points) {
  const std::size_t step = std::max<std::size_t>(1, channel.points() / points);
  Channel part;
  part.first.push_back(0);
  for (std::size_t point = 0; point < channel.points(); point += step) {
    for (std::size_t i = channel.first[point]; i < channel.first[point + 1]; ++i) {
      part.light.push_back(channel.light[i]);
      part.noise.push_back(channel.noise[i]);
      part.spread.push_back(channel.spread[i]);
      part.sigma.push_back(channel.sigma[i]);
      part.weight.push_back(channel.weight[i]);
      part.sights.push_back(channel.sights[i]);
      part.views.push_back(channel.views[i]);
    }
    part.first.push_back(part.light.size());
  }
  return part;
}

void expect(Channel& channel, std::span<const double> factors, std::span<const double> surfaces) {
  constexpr double kShare = 0.03, kSpread = 0.25, kLeastFactor = 1e-6;
  for (std::size_t point = 0; point < channel.points(); ++point) {
    const std::size_t begin = channel.first[point], end = channel.first[point + 1];
    double spread = 0;
    for (std::size_t i = begin; i < end; ++i)
      spread +=
          channel.spread[i] / std::max(factors[i], kLeastFactor) / static_cast<double>(end - begin);
    const double texture = std::hypot(kShare * surfaces[point], kSpread * spread);
    for (std::size_t i = begin; i < end; ++i) {
      channel.sigma[i] = std::hypot(channel.noise[i], texture * factors[i]);
      channel.weight[i] = 1 / (channel.sigma[i] * channel.sigma[i]);
    }
  }
}

double direct_share(const Channel& channel, std::span<const double> factors,
                    std::span<const double> surfaces) {
  std::vector<double> shares;
  for (std::size_t point = 0; point < channel.points(); ++point)
    for (std::size_t i = channel.first[point]; i < channel.first[point + 1]; ++i)
      shares.push_back(surfaces[point] * factors[i] / std::max(channel.light[i], 1e-4));
  return upper_median(std::move(shares));
}

double weigh(Channel& channel, std::span<const double> residuals) {
  constexpr double kTuning = 2.385;  // 95 % of the efficiency for normal errors
  std::vector<double> sizes(residuals.size());
  for (std::size_t i = 0; i < sizes.size(); ++i)
    sizes[i] = std::abs(residuals[i]) / channel.sigma[i];
  const double scale = std::max(kSigmasOfMedian * upper_median(sizes), 1e-9);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double size = sizes[i] / (kTuning * scale);
    channel.weight[i] = 1 / ((1 + size * size) * channel.sigma[i] * channel.sigma[i]);
  }
  return scale;
}

}  // namespace axial::color
