// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/daylight.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/order_statistics.h"
#include "color/channel.h"

namespace axial::color {
namespace {

using Channels = Eigen::Array3d;  // R G B

struct Type {
  const char* name;
  double scattering;               // usual, at 550 nm [1/m]
  std::array<double, 9> daylight;  // K_d at 425, 450 ... 625 nm [1/m]
};

constexpr std::array<Type, 10> kTypes{{
    {"I", 0.10, {.022, .019, .018, .027, .043, .063, .089, .235, .305}},
    {"IA", 0.13, {.031, .026, .025, .032, .048, .067, .094, .240, .310}},
    {"IB", 0.16, {.042, .036, .033, .042, .054, .072, .099, .245, .315}},
    {"II", 0.25, {.081, .068, .062, .070, .076, .089, .115, .260, .335}},
    {"III", 0.40, {.160, .135, .116, .115, .116, .120, .148, .295, .375}},
    {"1C", 0.50, {.36, .25, .17, .14, .13, .12, .15, .30, .37}},
    {"3C", 0.70, {.54, .39, .29, .22, .20, .19, .21, .33, .40}},
    {"5C", 1.00, {.78, .56, .43, .36, .31, .30, .33, .40, .48}},
    {"7C", 1.40, {1.2, .89, .71, .58, .49, .46, .46, .48, .54}},
    {"9C", 2.00, {1.9, 1.6, 1.23, .99, .78, .63, .58, .60, .65}},
}};
constexpr const char* kBegin = "jerlov-";
constexpr double kMostTypes = kTypes.size() - 1;

// What the channels of usual cameras see of the wavelengths of Type::daylight. Under water, the
// longest wavelengths are lost first: the red channel sees less of them than in air.
constexpr std::array<std::array<double, 9>, 3> kSensitivities{{
    {0, 0, 0, 0, 0, 0, 0.3, 0.4, 0.3},
    {0, 0, 0, 0.15, 0.35, 0.35, 0.15, 0, 0},
    {0.15, 0.35, 0.35, 0.15, 0, 0, 0, 0, 0},
}};
constexpr std::array<double, 3> kMiddle{600, 535, 462};  // of the channels [nm]

Channels daylight_losses(const Type& type) {
  Channels losses = Channels::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < type.daylight.size(); ++i)
      losses[static_cast<Eigen::Index>(k)] += kSensitivities[k][i] * type.daylight[i];
  return losses;
}

// Between two types, by equal factors.
Channels daylight_losses(WaterType type) {
  const auto before = static_cast<std::size_t>(std::clamp(type, 0.0, kMostTypes - 1));
  const double share = type - static_cast<double>(before);
  return (daylight_losses(kTypes[before]).log() * (1 - share) +
          daylight_losses(kTypes[before + 1]).log() * share)
      .exp();
}

double usual_scattering(WaterType type) {
  const auto before = static_cast<std::size_t>(std::clamp(type, 0.0, kMostTypes - 1));
  const double share = type - static_cast<double>(before);
  return std::pow(kTypes[before].scattering, 1 - share) *
         std::pow(kTypes[before + 1].scattering, share);
}

// The share of scattered light that is lost along a ray. The rest is scattered by such small angles
// that it is only blurred.
constexpr double kLost = 0.65;

// Absorption and lost scattering along a ray. `scattering`: at 550 nm.
Channels beam_losses(const Channels& daylight, double scattering) {
  constexpr double kCosine = 0.86;
  Channels beams;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double s = scattering * 550 / kMiddle[static_cast<std::size_t>(k)];
    const double half = 0.5 * (0.425 * kCosine - 0.19) * s;
    beams[k] = std::hypot(half, kCosine * daylight[k]) - half + kLost * s;
  }
  return beams;
}

// Mean and standard deviation of values with weights.
class Weighted {
 public:
  void add(double value, double weight) {
    sum_ += weight;
    first_ += weight * value;
    second_ += weight * value * value;
  }
  Estimate estimate() const {
    const double mean = first_ / sum_;
    return {mean, std::sqrt(std::max(0.0, second_ / sum_ - mean * mean))};
  }

 private:
  double sum_ = 0, first_ = 0, second_ = 0;
};

// Half the squared differences between the channels and the losses, in standard deviations.
double cost_of(const SunWater& water, const Channels& beams) {
  constexpr double kShare = 0.1, kLeast = 0.03;
  double cost = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const SunChannel& channel = water.channels[k];
    if (!channel.determined) continue;
    const double expected = beams[static_cast<Eigen::Index>(k)];
    const double variance =
        std::pow(channel.a.sigma, 2) + std::pow(kShare * expected, 2) + kLeast * kLeast;
    cost += 0.5 * (std::pow(channel.a.value - expected, 2) / variance + std::log(variance));
  }
  return cost;
}

struct Candidate {
  WaterType type;
  Channels daylight, beams;
  double cost;
};

std::vector<Candidate> candidates(const SunWater& water, std::optional<WaterType> known) {
  constexpr int kTypeSteps = 90, kScatteringSteps = 40;
  constexpr double kFactor = 0.693;  // standard deviation of the logarithm of scattering
  std::vector<Candidate> all;
  for (int i = 0; i <= (known ? 0 : kTypeSteps); ++i) {
    const WaterType type = known ? *known : kMostTypes * i / kTypeSteps;
    const Channels daylight = daylight_losses(type);
    for (int j = -kScatteringSteps; j <= kScatteringSteps; ++j) {
      const double away = 3.0 * j / kScatteringSteps;  // standard deviations
      const Channels beams =
          beam_losses(daylight, usual_scattering(type) * std::exp(away * kFactor));
      all.push_back({type, daylight, beams, cost_of(water, beams) + 0.5 * away * away});
    }
  }
  return all;
}

}  // namespace

WaterType parse_water_type(const std::string& name) {
  const auto found = std::ranges::find_if(
      kTypes, [&](const Type& type) { return name == std::string(kBegin) + type.name; });
  if (found == kTypes.end()) fail("water is '{}', but must be jerlov-I to jerlov-9C", name);
  return static_cast<double>(found - kTypes.begin());
}

std::string name_of(WaterType type) {
  const long nearest = std::lround(std::clamp(type, 0.0, kMostTypes));
  return std::string(kBegin) + kTypes[static_cast<std::size_t>(nearest)].name;
}

std::optional<Daylight> daylight_of(const SunWater& water, std::optional<WaterType> known) {
  if (!known && std::ranges::none_of(water.channels, &SunChannel::determined)) return {};
  const std::vector<Candidate> all = candidates(water, known);
  const Candidate& best = *std::ranges::min_element(all, {}, &Candidate::cost);
  std::array<Weighted, 3> losses, beams;
  for (const Candidate& candidate : all) {
    const double weight = std::exp(best.cost - candidate.cost);
    for (std::size_t k = 0; k < 3; ++k) {
      losses[k].add(candidate.daylight[static_cast<Eigen::Index>(k)], weight);
      beams[k].add(candidate.beams[static_cast<Eigen::Index>(k)], weight);
    }
  }
  Daylight daylight;
  daylight.type = best.type;
  for (std::size_t k = 0; k < 3; ++k) {
    daylight.losses[k] = losses[k].estimate();
    daylight.beams[k] = beams[k].estimate();
  }
  return daylight;
}

void assume(const Daylight& daylight, SunWater& water) {
  for (std::size_t k = 0; k < 3; ++k) {
    SunChannel& channel = water.channels[k];
    const bool hidden = channel.a.value > 0 && channel.direct < kLeastDirect;
    if (channel.determined || hidden) continue;
    channel.a = channel.b = daylight.beams[k];
    channel.veil = {};
    channel.veil_by_direction.setZero();
    channel.determined = channel.assumed = true;
  }
}

void remove_daylight_loss(const Daylight& daylight, const Observations& observations,
                          SunWater& water) {
  std::vector<float> heights;
  for (std::size_t point = 0; point < observations.points(); ++point)
    heights.push_back(observations.of(point).front().sight.height);
  if (heights.empty()) return;
  water.level = upper_median(std::move(heights));
  for (std::size_t k = 0; k < 3; ++k)
    if (water.channels[k].determined) water.channels[k].daylight = daylight.losses[k];
}

}  // namespace axial::color
