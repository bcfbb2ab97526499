// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/restore.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/order_statistics.h"
#include "base/parallel.h"

namespace axial::color {
namespace {

struct Loss {
  Eigen::Array3f factor, veil;
};

Loss loss_of(const WaterModel& model, const Sight& sight) {
  return std::visit(
      [&](const auto& water) {
        return Loss{water.factor(sight), water.veil(sight)};
      },
      model);
}

// Every second point, from the point `first` on.
Observations half_of(const Observations& all, std::size_t first) {
  Observations half;
  half.first.push_back(0);
  for (std::size_t point = first; point < all.points(); point += 2) {
    for (Observation seen : all.of(point)) {
      seen.point = static_cast<std::uint32_t>(half.points());
      half.all.push_back(seen);
    }
    half.first.push_back(half.all.size());
  }
  return half;
}

// The factor below which nothing can be restored: less than a thousandth of the light is left.
constexpr float kLeastFactor = 1e-3f;

// Halves `way` and `normal`, and counts only pixels with a way.
SightImage halved(const SightImage& sights) {
  const cv::Size size((sights.way.cols + 1) / 2, (sights.way.rows + 1) / 2);
  SightImage half{cv::Mat1f(size, 0.0f), cv::Mat3f(size, cv::Vec3f(0, 0, 0))};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      int count = 0;
      for (int j = 2 * y; j < std::min(2 * y + 2, sights.way.rows); ++j)
        for (int i = 2 * x; i < std::min(2 * x + 2, sights.way.cols); ++i) {
          if (!(sights.way(j, i) > 0)) continue;
          half.way(y, x) += sights.way(j, i);
          half.normal(y, x) += sights.normal(j, i);
          ++count;
        }
      if (count == 0) continue;
      half.way(y, x) /= static_cast<float>(count);
      half.normal(y, x) *= 1.0f / static_cast<float>(count);
    }
  return half;
}

std::uint16_t rounded(float value, int largest) {
  return static_cast<std::uint16_t>(value * static_cast<float>(largest) + 0.5f);
}

}  // namespace

Eigen::Array3f surface_light(const WaterModel& model, const Sight& sight,
                             const Eigen::Array3f& light) {
  const Loss loss = loss_of(model, sight);
  const std::array<bool, 3> known = determined(model);
  Eigen::Array3f surface = light;
  for (int k = 0; k < 3; ++k)
    if (known[static_cast<std::size_t>(k)])
      surface[k] = (light[k] - loss.veil[k]) / std::max(loss.factor[k], kLeastFactor);
  return surface;
}

std::array<bool, 3> determined(const WaterModel& model) {
  std::array<bool, 3> known{};
  std::visit(
      [&](const auto& water) {
        for (std::size_t k = 0; k < 3; ++k) known[k] = water.channels[k].determined;
      },
      model);
  return known;
}

double spread_of(const Observations& observations, const WaterModel* model) {
  double ratio = 0;
  for (int k = 0; k < 3; ++k) {
    std::vector<float> means, spreads;
    for (std::size_t point = 0; point < observations.points(); ++point) {
      float sum = 0, squares = 0;
      const auto seen = observations.of(point);
      for (const Observation& one : seen) {
        const float light = model ? surface_light(*model, one.sight, one.light)[k] : one.light[k];
        sum += light;
        squares += light * light;
      }
      const auto count = static_cast<float>(seen.size());
      const float mean = sum / count;
      if (!std::isfinite(mean)) continue;
      means.push_back(mean);
      spreads.push_back(
          std::sqrt(std::max(0.0f, squares / count - mean * mean) * count / (count - 1)));
    }
    const float middle = upper_median(means);
    for (float& mean : means) mean = std::abs(mean - middle);
    ratio += upper_median(std::move(spreads)) /
             (1.4826f * std::max(upper_median(std::move(means)), 1e-6f)) / 3;
  }
  return ratio;
}

Choice choose_light(const Observations& observations, const Transfer& transfer) {
  constexpr double kMuchBetter = 0.8;
  const Observations fitted = half_of(observations, 0), other = half_of(observations, 1);
  Choice choice;
  const WaterModel sun = fit_sun(fitted, transfer), lamps = fit_lamps(fitted, transfer);
  choice.sun_spread = spread_of(other, &sun);
  choice.lamp_spread = spread_of(other, &lamps);
  choice.light = choice.lamp_spread < kMuchBetter * choice.sun_spread ? Light::lamp : Light::sun;
  if (choice.light == Light::lamp)
    choice.model = fit_lamps(observations, transfer);
  else
    choice.model = fit_sun(observations, transfer);
  return choice;
}

void fill_sights(SightImage& sights) {
  if (sights.way.rows <= 1 && sights.way.cols <= 1) return;
  if (cv::countNonZero(sights.way) == static_cast<int>(sights.way.total())) return;
  SightImage half = halved(sights);
  fill_sights(half);
  for (int y = 0; y < sights.way.rows; ++y)
    for (int x = 0; x < sights.way.cols; ++x) {
      if (sights.way(y, x) > 0) continue;
      sights.way(y, x) = half.way(y / 2, x / 2);
      sights.normal(y, x) = half.normal(y / 2, x / 2);
    }
}

Eigen::Array3f grey_world(const Observations& observations, const WaterModel& model) {
  constexpr float kBrightest = 0.7f;
  constexpr double kShare = 0.99;
  std::array<std::vector<float>, 3> surfaces;
  for (const Observation& seen : observations.all) {
    const Eigen::Array3f light = surface_light(model, seen.sight, seen.light);
    if (!light.isFinite().all()) continue;
    for (int k = 0; k < 3; ++k) surfaces[static_cast<std::size_t>(k)].push_back(light[k]);
  }
  Eigen::Array3f gain = Eigen::Array3f::Ones();
  if (surfaces[0].empty()) return gain;
  float brightest = 0;
  for (int k = 0; k < 3; ++k) {
    const auto& channel = surfaces[static_cast<std::size_t>(k)];
    gain[k] = 1 / std::max(1e-6f, upper_median(channel));
    brightest = std::max(brightest, gain[k] * lower_quantile(channel, kShare));
  }
  return gain * (kBrightest / brightest);
}

Restored restore(const cv::Mat3f& light, SightImage sights, const CameraModel& camera,
                 const WaterModel& model, const Rendering& rendering) {
  const bool bytes = rendering.bits == 8;
  const int largest = bytes ? 255 : 65535;
  cv::Mat3w pixels(light.size());
  Restored restored{{}, cv::Mat1b(light.size(), 0)};
  const cv::Mat1f seen = sights.way.clone();
  fill_sights(sights);
  parallel_for(static_cast<std::size_t>(light.rows), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < light.cols; ++x) {
      const cv::Vec3f& raw = light(y, x);
      Eigen::Array3f color(raw[0], raw[1], raw[2]);
      const bool clipped = !color.isFinite().all();
      color = color.isFinite().select(color, 1.0f);
      const cv::Vec3f& n = sights.normal(y, x);
      const Sight sight{place_of({x, y}, camera), sights.way(y, x),
                        Eigen::Vector3f(n[0], n[1], n[2]).normalized()};
      const Eigen::Array3f surface = surface_light(model, sight, color) * rendering.gain;
      for (int k = 0; k < 3; ++k)
        pixels(y, x)[2 - k] = rounded(rendering.transfer.value(surface[k]), largest);
      // The smallest change of J that a grey level shows.
      const Eigen::Array3f level =
          1 / (255 * (loss_of(model, sight).factor / rendering.gain).max(1e-9f));
      const bool is_left = (level * kLeastLevels < 1).all();
      if (!clipped && seen(y, x) > 0 && is_left) restored.known(y, x) = 255;
    }
  });
  if (bytes)
    pixels.convertTo(restored.pixels, CV_8UC3);
  else
    restored.pixels = pixels;
  return restored;
}

}  // namespace axial::color
