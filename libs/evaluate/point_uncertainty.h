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

// Each array is empty or has one element for each point.
struct PointUncertainty {
  std::vector<std::uint32_t> views;  // number of depth maps from which the point was fused
  std::vector<float> error;          // expected standard deviation [m]
  std::vector<float> confidence;     // 0 to 1
};

// Errors of the points that were fused from `least` to `most` depth maps.
struct ErrorsOfViews {
  std::uint32_t least = 0, most = 0;  // most 0: no upper limit
  std::size_t points = 0;
  double share = 0;             // `points` divided by the number of all points
  double mean = 0, median = 0;  // of the distances to the truth [m]
  double gross_share = 0;       // share of these points farther from the truth than `gross`
  std::vector<double> within;   // share of these points within each tolerance
};

// Returns three classes of points: fused from up to 2 depth maps, from 3, and from 4 or more.
// `views`: number of depth maps of each point. `distances`: from each point to the truth [m].
// `tolerances` and `gross`: [m].
std::vector<ErrorsOfViews> errors_by_views(std::span<const std::uint32_t> views,
                                           std::span<const float> distances,
                                           std::span<const double> tolerances, double gross);

// The reliability of the points whose confidence is in [begin, end). The last class includes its
// end. Only points with a positive and finite expected error count.
struct Reliability {
  double begin = 0, end = 0;
  std::size_t points = 0;
  double mean_confidence = 0;
  // Share of points whose distance to the truth is at most kReliableErrors * expected error.
  double within = 0;
};
inline constexpr double kReliableErrors = 3;

// Statistics of normalised errors. The normalised error of a point is its distance to the truth
// divided by its expected error. Only points with a positive and finite expected error count.
struct NormalisedErrors {
  std::size_t points = 0;
  double rms = 0;  // 1 if the expected errors are calibrated
  double median = 0;
  std::array<double, 3> within{};  // shares of the points with a normalised error up to 1, 2 and 3
};

// Normalised errors of the points that were fused from `least` to `most` depth maps.
struct NormalisedErrorsOfViews {
  std::uint32_t least = 0, most = 0;  // most 0: no upper limit
  NormalisedErrors errors;
};

struct Calibration {
  NormalisedErrors all;
  std::vector<NormalisedErrorsOfViews> by_views;  // as in errors_by_views; empty without views
  std::vector<Reliability> reliability;           // empty without confidences
};

// Compares the expected errors with the true errors. `distances`: from each point to the truth [m].
// Returns nothing if `uncertainty.error` is empty. Error if a confidence is outside [0, 1].
std::optional<Calibration> calibration_of(const PointUncertainty& uncertainty,
                                          std::span<const float> distances);

}  // namespace axial::evaluate
