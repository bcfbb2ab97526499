// SPDX-License-Identifier: GPL-3.0-or-later
// Water in daylight: I = J exp(-a d) + B (1 - exp(-b d)) in each channel, with the way d in water.
// The light J of each surface point is estimated with a, b and B. Two coefficients, because the
// light of the surface and the veil are lost at different rates (Akkaynak and Treibitz 2018).
#pragma once

#include <array>

#include "color/observations.h"
#include "color/transfer.h"

namespace axial::color {

// A number with its standard deviation.
struct Estimate {
  double value = 0, sigma = 0;
};

struct SunChannel {
  Estimate a, b;  // [1/m]
  Estimate veil;  // B, linear light, in the direction SunWater::middle
  // In other directions, B is larger by the factor exp(this . (direction - middle)): water scatters
  // daylight more by smaller angles.
  Eigen::Vector3d veil_by_direction = Eigen::Vector3d::Zero();
  double direct = 0;  // the share of light that comes from the surface: direct_share()
  // Whether the photographs determine `a`: its standard deviation is at most 30 % of it, and
  // `direct` is at least kLeastDirect.
  bool determined = false;
  bool assumed = false;  // `a` and `b` are those of a type of water (daylight.h)
  double residual = 0;   // robust standard deviation of I, in expected standard deviations
  // How fast daylight grows with the height [1/m]; 0: not taken into account.
  Estimate daylight = {};
};

struct SunWater {
  std::array<SunChannel, 3> channels;                // R G B
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // the mean of Sight::direction
  double level = 0;  // height at which J is the light of the surface: the median of the points [m]

  // I = J factor + veil.
  Eigen::Array3f factor(const Sight& sight) const;
  Eigen::Array3f veil(const Sight& sight) const;
};

// Fits the model, robustly. Standard deviations are by the scatter between photographs. A channel
// with observations of fewer than ten points stays 0 and not determined.
SunWater fit_sun(const Observations& observations, const Transfer& transfer);

}  // namespace axial::color
