// SPDX-License-Identifier: GPL-3.0-or-later
// What a cloud says its points are worth, against their true errors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace axial::evaluate {

// Each array is empty, or one a point.
struct PointWorth {
  std::vector<std::uint32_t> views;  // depth maps that the point rests on
  std::vector<float> error;          // expected standard deviation [m]
  std::vector<float> confidence;     // 0 to 1
};

// Of the points that rest on `least` to `most` views.
struct ErrorsOfViews {
  std::uint32_t least = 0, most = 0;  // most 0: or more
  std::size_t points = 0;
  double share = 0;  // of all points
  double mean = 0, median = 0;
  double gross_share = 0;      // of these points: farther from the truth than `gross`
  std::vector<double> within;  // share of these points within each tolerance
};

// Up to 2 views, exactly 3, and 4 or more. `distances`: of each point to the truth.
std::vector<ErrorsOfViews> errors_by_views(std::span<const std::uint32_t> views,
                                           std::span<const float> distances,
                                           std::span<const double> tolerances, double gross);

// Of the points whose confidence is in [begin, end), the last class with its end.
struct Reliability {
  double begin = 0, end = 0;
  std::size_t points = 0;
  double mean_confidence = 0;
  double within = 0;  // share of them within kReliableErrors expected errors of the truth
};
inline constexpr double kReliableErrors = 3;

// Distances to the truth / expected errors, of the points with an expected error above 0.
struct NormalisedErrors {
  std::size_t points = 0;
  double rms = 0;  // 1 if they are calibrated
  double median = 0;
  std::array<double, 3> within{};  // share of the points within 1, 2 and 3 expected errors
};

// Of the points that rest on `least` to `most` views.
struct NormalisedErrorsOfViews {
  std::uint32_t least = 0, most = 0;  // most 0: or more
  NormalisedErrors errors;
};

struct Calibration {
  NormalisedErrors all;
  std::vector<NormalisedErrorsOfViews> by_views;  // classes as above; empty unless views are known
  std::vector<Reliability> reliability;           // empty unless there are confidences
};

// Nothing where no expected errors are known. Error for a confidence outside [0, 1].
std::optional<Calibration> calibration_of(const PointWorth& worth,
                                          std::span<const float> distances);

}  // namespace axial::evaluate
