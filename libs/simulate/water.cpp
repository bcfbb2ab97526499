// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/water.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace axial::simulate {
namespace {

struct Type {
  std::string_view name;
  double scattering;                // usual, at 550 nm [1/m]
  std::array<double, 13> daylight;  // K_d at 400, 425 ... 700 nm [1/m]
};

constexpr std::array<Type, 10> kTypes{{
    {"I", 0.10, {.028, .022, .019, .018, .027, .043, .063, .089, .235, .305, .360, .420, .560}},
    {"IA", 0.13, {.038, .031, .026, .025, .032, .048, .067, .094, .240, .310, .370, .430, .570}},
    {"IB", 0.16, {.051, .042, .036, .033, .042, .054, .072, .099, .245, .315, .375, .435, .580}},
    {"II", 0.25, {.096, .081, .068, .062, .070, .076, .089, .115, .260, .335, .400, .465, .610}},
    {"III", 0.40, {.185, .160, .135, .116, .115, .116, .120, .148, .295, .375, .445, .520, .660}},
    {"1C", 0.50, {.51, .36, .25, .17, .14, .13, .12, .15, .30, .37, .45, .51, .65}},
    {"3C", 0.70, {.78, .54, .39, .29, .22, .20, .19, .21, .33, .40, .46, .56, .71}},
    {"5C", 1.00, {1.1, .78, .56, .43, .36, .31, .30, .33, .40, .48, .54, .65, .80}},
    {"7C", 1.40, {1.6, 1.2, .89, .71, .58, .49, .46, .46, .48, .54, .63, .78, .92}},
    {"9C", 2.00, {2.4, 1.9, 1.6, 1.23, .99, .78, .63, .58, .60, .65, .76, .92, 1.1}},
}};

// The absorption that belongs to K_d, by Kirk's relation solved for a.
double absorption_of(double daylight_loss, double scattering) {
  constexpr double kCosine = 0.86;
  const double half = 0.5 * (0.425 * kCosine - 0.19) * scattering;
  const double path = kCosine * daylight_loss;
  return std::sqrt(half * half + path * path) - half;
}

}  // namespace

Water jerlov_water(std::string_view type, std::optional<double> scattering) {
  const auto found = std::ranges::find(kTypes, type, &Type::name);
  if (found == kTypes.end())
    fail("water is '{}', but must be I, IA, IB, II, III, 1C, 3C, 5C, 7C or 9C", type);
  if (scattering && !(*scattering >= 0 && *scattering <= 20))
    fail("scattering is {} 1/m: must be between 0 and 20", *scattering);
  Water water;
  water.type = type;
  water.daylight_loss = spectrum_of(found->daylight);
  for (int band = 0; band < kBands; ++band) {
    const double b = scattering.value_or(found->scattering) * 550 / wavelength(band);
    water.scattering[band] = static_cast<float>(b);
    water.absorption[band] = static_cast<float>(absorption_of(water.daylight_loss[band], b));
  }
  return water;
}

double phase(double cosine) {
  constexpr double g = 0.85;
  return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

Eigen::Vector3f PlainWater::seen(const Eigen::Vector3f& color, double d) const {
  const auto way = static_cast<float>(d);
  return (color.array() * (-a * way).exp() + veil * (1 - (-b * way).exp())).matrix();
}

}  // namespace axial::simulate
