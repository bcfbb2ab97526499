// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/restore.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

// The factor below which light stays as it is: less than a thousandth of it is left.
constexpr float kLeastFactor = 1e-3f;

// The means of two by two pixels, of those with a way.
SightImage halved(const SightImage& sights) {
  SightImage half((sights.width + 1) / 2, (sights.height + 1) / 2);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      float count = 0;
      Sight sum;
      sum.normal.setZero();
      for (int j = 2 * y; j < std::min(2 * y + 2, sights.height); ++j)
        for (int i = 2 * x; i < std::min(2 * x + 2, sights.width); ++i) {
          const Sight& one = sights.at(i, j);
          if (!(one.way > 0)) continue;
          sum.way += one.way;
          sum.normal += one.normal;
          sum.height += one.height;
          ++count;
        }
      if (count > 0)
        half.at(x, y) = {Eigen::Vector2f::Zero(), sum.way / count, sum.normal / count,
                         Eigen::Vector3f::Zero(), sum.height / count};
    }
  return half;
}

std::uint16_t rounded(float value, int largest) {
  if (!(value > 0)) return 0;
  return static_cast<std::uint16_t>(value * static_cast<float>(largest) + 0.5f);
}

}  // namespace

Eigen::Array3f surface_light(const WaterModel& model, const Sight& sight,
                             const Eigen::Array3f& light) {
  const Loss loss = loss_of(model, sight);
  const std::array<bool, 3> known = determined(model);
  Eigen::Array3f surface = light;
  for (int k = 0; k < 3; ++k)
    if (known[static_cast<std::size_t>(k)] && loss.factor[k] >= kLeastFactor)
      surface[k] = (light[k] - loss.veil[k]) / loss.factor[k];
  return surface;
}

Eigen::Array3f light_of_surface(const WaterModel& model, const Sight& sight,
                                const Eigen::Array3f& surface) {
  const Loss loss = loss_of(model, sight);
  return surface * loss.factor + loss.veil;
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
  double sum_of_ratios = 0;
  int channels = 0;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> means, spreads;
    for (std::size_t point = 0; point < observations.points(); ++point) {
      double sum = 0, squares = 0;
      const auto seen = observations.of(point);
      for (const Observation& one : seen) {
        const double light = model ? surface_light(*model, one.sight, one.light)[k] : one.light[k];
        sum += light;
        squares += light * light;
      }
      const auto count = static_cast<double>(seen.size());
      const double mean = sum / count;
      if (!std::isfinite(mean)) continue;
      means.push_back(mean);
      spreads.push_back(
          std::sqrt(std::max(0.0, squares / count - mean * mean) * count / (count - 1)));
    }
    const double contrast = robust_deviation(std::move(means));
    if (!(contrast > 0)) continue;
    sum_of_ratios += upper_median(std::move(spreads)) / contrast;
    ++channels;
  }
  return channels == 0 ? std::numeric_limits<double>::infinity() : sum_of_ratios / channels;
}

Choice choose_light(const Observations& observations, const Transfer& transfer) {
  constexpr double kMuchBetter = 0.8;
  const Observations fitted = every(2, 0, observations), other = every(2, 1, observations);
  Choice choice;
  const WaterModel sun = fit_sun(fitted, transfer), lamps = fit_lamps(fitted, transfer);
  choice.sun_spread = spread_of(other, &sun);
  choice.lamp_spread = spread_of(other, &lamps);
  choice.light = choice.lamp_spread < kMuchBetter * choice.sun_spread ? Light::lamp : Light::sun;
  choice.model = fit_light(observations, transfer, choice.light).model;
  return choice;
}

Choice fit_light(const Observations& observations, const Transfer& transfer,
                 std::optional<Light> light) {
  if (!light) return choose_light(observations, transfer);
  Choice choice;
  choice.light = *light;
  if (choice.light == Light::sun)
    choice.model = fit_sun(observations, transfer);
  else
    choice.model = fit_lamps(observations, transfer);
  return choice;
}

void fill_sights(SightImage& sights) {
  const auto is_empty = [](const Sight& sight) { return !(sight.way > 0); };
  if (sights.all.size() <= 1 || std::ranges::none_of(sights.all, is_empty)) return;
  SightImage half = halved(sights);
  fill_sights(half);
  for (int y = 0; y < sights.height; ++y)
    for (int x = 0; x < sights.width; ++x) {
      Sight& sight = sights.at(x, y);
      if (!is_empty(sight)) continue;
      const Sight& coarse = half.at(x / 2, y / 2);
      if (is_empty(coarse)) continue;
      sight.way = coarse.way;
      sight.normal = coarse.normal.normalized();
      sight.height = coarse.height;
    }
}

Eigen::Array3f grey_world(const Observations& observations, const WaterModel& model) {
  constexpr float kBrightest = 0.7f;
  constexpr double kShare = 0.99;
  const std::array<bool, 3> known = determined(model);
  Eigen::Array3f gain = Eigen::Array3f::Ones();
  float brightest = 0;
  for (int k = 0; k < 3; ++k) {
    if (!known[static_cast<std::size_t>(k)]) continue;
    std::vector<float> surfaces;
    for (const Observation& seen : observations.all) {
      const float light = surface_light(model, seen.sight, seen.light)[k];
      if (std::isfinite(light)) surfaces.push_back(light);
    }
    gain[k] = 1 / std::max(upper_median(surfaces), 1e-4f);
    brightest = std::max(brightest, gain[k] * lower_quantile(std::move(surfaces), kShare));
  }
  for (int k = 0; k < 3; ++k)
    if (known[static_cast<std::size_t>(k)]) gain[k] *= kBrightest / std::max(brightest, 1e-4f);
  return gain;
}

Restored restore(const cv::Mat3f& light, const cv::Mat1b& mask, SightImage sights,
                 const WaterModel& model, const Rendering& rendering) {
  const bool bytes = rendering.bits == 8;
  const int largest = bytes ? 255 : 65535;
  const float clipped = clipped_light(rendering.transfer);
  const std::array<bool, 3> in_model = determined(model);
  cv::Mat3w pixels(light.size());
  Restored restored{{}, cv::Mat1b(light.size(), 0)};
  const SightImage seen = sights;
  fill_sights(sights);
  parallel_for(static_cast<std::size_t>(light.rows), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < light.cols; ++x) {
      const cv::Vec3f& raw = light(y, x);
      const Eigen::Array3f color(raw[0], raw[1], raw[2]);
      const Eigen::Array3f evenly = color / rendering.exposure;
      const Sight sight = sights.at(x, y);
      const bool has_sight = sight.way > 0;  // false: the photograph shows no surface at all
      const Eigen::Array3f surface =
          (has_sight ? surface_light(model, sight, evenly) : evenly) * rendering.gain;
      bool known = seen.at(x, y).way > 0 && (mask.empty() || mask(y, x) != 0);
      const Eigen::Array3f factor = loss_of(model, sight).factor / rendering.gain;
      for (int k = 0; k < 3; ++k) {
        pixels(y, x)[2 - k] = rounded(rendering.transfer.value(surface[k]), largest);
        const bool is_left =
            !in_model[static_cast<std::size_t>(k)] || factor[k] * 255 >= kLeastLevels;
        known = known && color[k] < clipped && is_left;
      }
      restored.known(y, x) = known ? 255 : 0;
    }
  });
  if (bytes)
    pixels.convertTo(restored.pixels, CV_8UC3);
  else
    restored.pixels = pixels;
  return restored;
}

}  // namespace axial::color
