// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the errors that a cloud expects of its points with the true errors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace axial::evaluate {

// Properties of the points that a cloud may contain. Each array has one element for each point, or
// is empty if the cloud does not contain the property.
struct PointUncertainty {
  std::vector<std::uint32_t> views;  // number of depth maps from which the point was fused
  // Expected standard deviation of the point [m]. Not positive or not finite: unknown.
  std::vector<float> error;
  std::vector<float> confidence;  // from 0 to 1; larger: more reliable
};

// Errors of the points that were fused from `least` to `most` depth maps. Without such points all
// numbers besides the limits are 0.
struct ErrorsOfViews {
  std::uint32_t least = 0, most = 0;  // most 0: no upper limit
  std::size_t points = 0;             // number of points in the class
  double share = 0;                   // `points` divided by the number of all points
  double mean = 0, median = 0;        // of the distances of the class to the truth [m]
  double gross_share = 0;  // share of the class that is farther from the truth than `gross`
  // For each tolerance, the share of the class whose distance is at most the tolerance.
  std::vector<double> within;
};

// Returns three classes of points, in this order: fused from up to 2 depth maps, from 3, and from 4
// or more. `views`: number of depth maps of each point. `distances`: from each point to the truth
// [m], in the same order of points. `tolerances` and `gross`: [m].
std::vector<ErrorsOfViews> errors_by_views(std::span<const std::uint32_t> views,
                                           std::span<const float> distances,
                                           std::span<const double> tolerances, double gross);

// The reliability of the points whose confidence is in [begin, end). The class that ends at 1
// includes 1. Only points with a positive and finite expected error count.
struct Reliability {
  double begin = 0, end = 0;
  std::size_t points = 0;      // number of points in the class
  double mean_confidence = 0;  // of the class; 0 without points
  // Share of the class whose distance to the truth is at most kReliableErrors * expected error; 0
  // without points.
  double within = 0;
};
inline constexpr double kReliableErrors = 3;

// Statistics of normalised errors. The normalised error of a point is its distance to the truth
// divided by its expected error. Only points with a positive and finite expected error count.
// Without such points all numbers are 0.
struct NormalisedErrors {
  std::size_t points = 0;  // number of points that count
  double rms = 0;          // 1 if the expected errors are calibrated
  double median = 0;
  std::array<double, 3> within{};  // shares of the points with a normalised error up to 1, 2 and 3
};

// Normalised errors of the points that were fused from `least` to `most` depth maps.
struct NormalisedErrorsOfViews {
  std::uint32_t least = 0, most = 0;  // most 0: no upper limit
  NormalisedErrors errors;
};

struct Calibration {
  NormalisedErrors all;  // of all points that count
  // The classes of errors_by_views(). Empty if PointUncertainty::views is empty.
  std::vector<NormalisedErrorsOfViews> by_views;
  // Ten classes of equal width over [0, 1], in ascending order. Empty if
  // PointUncertainty::confidence is empty.
  std::vector<Reliability> reliability;
};

// Compares the expected errors with the true errors. `distances`: from each point to the truth [m],
// in the order of the points in `uncertainty`. Returns nothing if `uncertainty.error` is empty.
// Error if a confidence is outside [0, 1].
std::optional<Calibration> calibration_of(const PointUncertainty& uncertainty,
                                          std::span<const float> distances);

}  // namespace axial::evaluate
