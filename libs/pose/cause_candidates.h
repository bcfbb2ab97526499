// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a camera that may cause errors, with the cameras that differ in them.
#pragma once

#include <string>
#include <vector>

#include "scene/camera_model.h"

namespace axial::pose {

// One number. The derivative of a pixel by the number is the difference of its projections by
// `high` and `low`, divided by `step`.
struct CandidateNumber {
  std::string name, unit;
  double stated = 0;      // [unit]
  CameraModel low, high;  // the camera with two values of the number
  double step = 0;        // between the two values [unit]
};

// Numbers that are changed together. `numbers`: indices into the list of numbers.
struct Candidate {
  std::string name;
  std::vector<std::size_t> numbers;
};

struct Candidates {
  std::vector<CandidateNumber> numbers;
  std::vector<Candidate> candidates;
};

// The names of numbers that cannot be negative.
inline constexpr const char* kIndexName = "index of the water";
inline constexpr const char* kDistanceName = "distance of the port";
inline constexpr const char* kThicknessName = "thickness of the glass";
inline constexpr const char* kRadiusName = "radius of the dome";
inline constexpr const char* kFocalName = "focal length";

// The candidates of `camera`, as residual_causes() describes them.
Candidates candidates_of(const CameraModel& camera);

}  // namespace axial::pose
