// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/anchor.h"

#include <algorithm>
#include <cmath>

#include "base/order_statistics.h"

namespace axial::refine {
namespace {

// The residuals of a vertex depend on each other: a photograph takes part in many pairs, and noise
// in neighbouring pixels is correlated. The variance of a measurement is this multiple of 1 / I;
// found on simulated scenes, by the difference from the truth.
constexpr double kDependence = 9;
constexpr double kUsualDeviations = 2;  // at this many, the weight is one half
constexpr double kFromAround = 0.1;

double median_of_positive(std::span<const double> values) {
  std::vector<double> positive;
  for (const double value : values)
    if (value > 0) positive.push_back(value);
  return upper_median(std::move(positive));
}

}  // namespace

std::vector<float> offsets(std::span<const Eigen::Vector3f> vertices,
                           std::span<const Eigen::Vector3f> first, const Shape& shape) {
  std::vector<float> result(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v)
    result[v] = shape.normals[v].dot(vertices[v] - first[v]);
  return result;
}

std::vector<double> anchor_weights(std::span<const double> information,
                                   std::span<const float> offset,
                                   std::span<const float> displacement,
                                   const AnchorOptions& options) {
  const double around = kFromAround * median_of_positive(information);
  const double weight = options.weight / std::pow(options.factor, 4);
  std::vector<double> weights(information.size());
  for (std::size_t v = 0; v < weights.size(); ++v) {
    const double moved = static_cast<double>(offset[v]) + displacement[v];
    const double variances = moved * moved * information[v] / kDependence;
    weights[v] = weight * (information[v] + around) /
                 (1 + variances / (kUsualDeviations * kUsualDeviations));
  }
  return weights;
}

}  // namespace axial::refine
