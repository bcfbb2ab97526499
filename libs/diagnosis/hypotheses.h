// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a camera that may be wrong: which of them are wrong alone or together, and the
// cameras that differ in one of them.
#pragma once

#include <string>
#include <vector>

#include "pose/bundle/housing_numbers.h"
#include "scene/camera_model.h"

namespace axial::diagnosis {

// The groups of numbers of a port of this kind that can be wrong alone, as groups of numbers of
// pose/bundle/housing_numbers.h: those of the index, of the place of the port, and of the focal
// length. The thickness of the glass is not among them, because it is easy to measure.
std::vector<pose::NumberGroup> groups_to_free(pose::PortKind kind);

// A number and two cameras that differ in it. The derivative of a pixel by the number is the
// difference of its projections by `high` and `low`, divided by `step`. `number` has the stated
// value.
struct NumberStep {
  pose::HousingNumber number;
  CameraModel low, high;
  double step = 0;  // between the two values [unit of the number]
};

// Numbers that are wrong together. `numbers`: indices into the list of numbers.
struct Hypothesis {
  std::string name;
  std::vector<std::size_t> numbers;
};

struct Hypotheses {
  std::vector<NumberStep> numbers;
  std::vector<Hypothesis> hypotheses;
};

// The hypotheses about `camera`, as residual_causes() describes them.
Hypotheses hypotheses_of(const CameraModel& camera);

}  // namespace axial::diagnosis
