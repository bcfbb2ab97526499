// SPDX-License-Identifier: GPL-3.0-or-later
// One channel of observations, with the weights of a robust fit.
#pragma once

#include <span>
#include <vector>

#include "color/observations.h"
#include "color/transfer.h"

namespace axial::color {

// Observations that are not clipped, sorted by point.
struct Channel {
  std::vector<double> light;          // linear
  std::vector<double> noise, spread;  // see expect()
  std::vector<double> sigma;          // expected standard deviation of the light
  std::vector<double> weight;         // of the squared residual: robust weight / sigma^2
  std::vector<Sight> sights;
  std::vector<std::uint32_t> views;
  std::vector<std::size_t> first;  // as Observations::first

  std::size_t points() const { return first.size() - 1; }
};

// The channel (0 to 2: R G B) of the observations. Points with fewer than two observations are left
// out. `noise` is one grey level of 8 bits at the mean light of the point, and `spread` that of the
// observation. Expected standard deviations are those for equal factors.
Channel channel_of(const Observations& observations, int channel, const Transfer& transfer);

// About `points` points, evenly from all, with their observations.
Channel part_of(const Channel& channel, std::size_t points);

// Sets `sigma` for light = J factor + veil. Poses and surface have errors, so that J differs
// between the observations of a point: by 3 % of J, and by a quarter of the spread of J nearby.
// This part is proportional to the factor. With other proportions the fit is biased, because J is
// estimated, too: it is a regression with errors in both variables. `surfaces`: J of each point.
void expect(Channel& channel, std::span<const double> factors, std::span<const double> surfaces);

// The share of the light that comes from the surface: the median of J factor / light. Below
// kLeastDirect, small errors of the veil are large errors of J.
double direct_share(const Channel& channel, std::span<const double> factors,
                    std::span<const double> surfaces);
inline constexpr double kLeastDirect = 0.03;

// Sets the weights by Cauchy's function of residual / sigma over a robust scale. Returns the scale:
// 1.4826 times the median of |residual / sigma|.
double weigh(Channel& channel, std::span<const double> residuals);

}  // namespace axial::color
