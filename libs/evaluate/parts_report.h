// SPDX-License-Identifier: GPL-3.0-or-later
// Reports the parts of an evaluation (by number of views, by thickness, by expected error, along a
// strip) as text for people and as JSON for programs (fields: docs/evaluate.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "evaluate/places.h"
#include "evaluate/point_uncertainty.h"
#include "evaluate/strip.h"

namespace axial::evaluate {

// Classes keep their order and become a list of objects. A Calibration and a Strip become an
// object. Lengths are metres, except that a thickness is in pixels. Null stands for:
// - "most" of a class without an upper limit, and "least" of the class that is not thin
// - the recall of a class without places
// - the mean, median, RMS and shares of a class without points, except that "share" (of all points)
//   and "within_1_2_3" are 0
// - "ratio" of a strip (`most` / `least`) if `least` is 0
nlohmann::ordered_json to_json(std::span<const RecallOfViews> classes);
nlohmann::ordered_json to_json(std::span<const RecallOfThickness> classes);
nlohmann::ordered_json to_json(std::span<const ErrorsOfViews> classes);
nlohmann::ordered_json to_json(const Calibration& calibration);
nlohmann::ordered_json to_json(const Strip& strip);

// Return lines of text, each with a line break at the end. Lengths are millimetres, except that a
// thickness is in pixels. `tolerances` [m]: the tolerances from which the classes were made, in the
// same order.
std::string table(std::span<const RecallOfViews> classes, std::span<const double> tolerances);
std::string table(std::span<const RecallOfThickness> classes, std::span<const double> tolerances);
std::string table(std::span<const ErrorsOfViews> classes, std::span<const double> tolerances);
std::string table(const Calibration& calibration);
std::string table(const Strip& strip);

}  // namespace axial::evaluate
