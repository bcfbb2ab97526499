// SPDX-License-Identifier: GPL-3.0-or-later
#include "lens/lens_fit.h"

#include <Eigen/QR>
#include <cmath>
#include <numbers>

namespace axial::lens {
namespace {

using Distortion = refractive::LensDistortion<double>;
constexpr int kAbove = std::tuple_size_v<decltype(Distortion::above)>;
constexpr int kBelow = std::tuple_size_v<decltype(Distortion::below)>;
constexpr int kUnknowns = kAbove + kBelow;

// Solves above(t) - radius(theta) t below(t) = radius(theta) with t = (theta / widest)^2, which is
// linear in the coefficients of both polynomials. At Chebyshev nodes the largest error of the fit
// is nearly minimal. Rows are weighted with theta, so that a residual is an error in the image.
Eigen::Vector<double, kUnknowns> coefficients(const std::function<double(double)>& radius,
                                              double widest) {
  constexpr int kNodes = 64;
  Eigen::Matrix<double, kNodes, kUnknowns> rows;
  Eigen::Vector<double, kNodes> values;
  for (int i = 0; i < kNodes; ++i) {
    const double t = (1 - std::cos(std::numbers::pi * (i + 0.5) / kNodes)) / 2;
    const double theta = widest * std::sqrt(t), imaged = radius(theta);
    double power = 1;
    for (int k = 0; k < kAbove; ++k, power *= t) {
      rows(i, k) = theta * power;
      if (k < kBelow) rows(i, kAbove + k) = -imaged * t * power;
    }
    values(i) = imaged;
  }
  return rows.colPivHouseholderQr().solve(values);
}

Distortion lens_of(const Eigen::Vector<double, kUnknowns>& x, double widest) {
  Distortion lens;
  lens.fisheye = 1;
  const double unit = 1 / (widest * widest);
  double power = 1;
  for (int k = 0; k < kAbove; ++k, power *= unit) {
    lens.above[static_cast<std::size_t>(k)] = x(k) * power;
    if (k < kBelow) lens.below[static_cast<std::size_t>(k)] = x(kAbove + k) * power * unit;
  }
  return lens;
}

bool has_a_pole(const Distortion& lens, double theta) {
  const double s = theta * theta;
  return !(1 + s * (lens.below[0] + s * (lens.below[1] + s * lens.below[2])) > 0);
}

}  // namespace

std::optional<Distortion> fitted_fisheye(const std::function<double(double)>& radius, double widest,
                                         double tolerance) {
  const Distortion lens = lens_of(coefficients(radius, widest), widest);
  constexpr int kChecks = 1000;
  for (int i = 1; i <= kChecks; ++i) {
    const double theta = widest * i / kChecks;
    const double miss = lens.bent({theta, 0}).point.x() - radius(theta);
    if (has_a_pole(lens, theta) || !(std::abs(miss) <= tolerance)) return std::nullopt;
  }
  return lens;
}

}  // namespace axial::lens
