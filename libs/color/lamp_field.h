// SPDX-License-Identifier: GPL-3.0-or-later
// Lamps that are fixed to the camera: I = J E(place, d) . n + V(place, d) in each channel.
//
// E is the irradiance as a vector, times the loss on the way to the camera: for a Lambertian
// surface that all lamps reach, the irradiance of the surface is linear in its normal n, however
// many lamps there are. E is interpolated in a grid of image positions and ways. V, the veil, is
// V(place) T(d): T is the light that a lamp 0.25 m from the camera's axis and the water along
// the way scatter, as a share of that of a long way. Nothing about the lamps has to be known.
#pragma once

#include <array>
#include <vector>

#include "color/observations.h"
#include "color/transfer.h"

namespace axial::color {

// The nodes of the grid: by places in the image and ways.
struct LampGrid {
  int across = 7, down = 5, along = 6;
  float half_height = 1;            // of the image, in Sight::place
  float nearest = 0, farthest = 1;  // ways of the first and last nodes [m]

  int places() const { return across * down; }
  int nodes() const { return places() * along; }
};

// The least LampChannel::loss [1/m].
inline constexpr double kLeastLoss = 0.02;

struct LampChannel {
  double direct = 0;  // the share of light that comes from the surface: direct_share()
  // Whether the photographs determine J: its median standard deviation is at most 30 % of its mean
  // and at most half of what J differs by between points, and `direct` is at least kLeastDirect.
  // Never with fewer than 200 points.
  bool determined = false;
  // Rate in the factor exp(-2 loss d) / d^2 of E [1/m]. kLeastLoss: the light of the points does
  // not fall with the way as light of lamps does, because the veil outshines them, or because it is
  // daylight.
  double loss = 0;
  std::vector<Eigen::Vector3d> light;  // E without this factor, at the nodes; in the camera frame
  std::vector<double> veil;            // V at places
  std::vector<float> saturation;       // T at ways from 0 to the farthest, at equal steps
  double residual = 0;  // robust standard deviation of I, in expected standard deviations
};

struct LampField {
  LampGrid grid;
  std::array<LampChannel, 3> channels;  // R G B

  // I = J factor + veil. Places and ways outside the grid are moved to its border; the factor
  // exp(-2 loss d) / d^2 is exact. The factor is at least 0.
  Eigen::Array3f factor(const Sight& sight) const;
  Eigen::Array3f veil(const Sight& sight) const;
};

// Fits the field to observations without shadows (Observation::open), robustly. The mean of J over
// the points is 0.25 in each channel.
LampField fit_lamps(const Observations& observations, const Transfer& transfer);

}  // namespace axial::color
