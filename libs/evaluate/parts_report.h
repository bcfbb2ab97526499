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

// In the JSON, the recall of a class without places is null. The mean, median, RMS and shares of a
// class without points are null, too, except for "share" (of all points) and "within_1_2_3". The
// "ratio" of a strip is null if `least` is 0. Lengths are metres in the JSON and millimetres in the
// tables. `tolerances` [m]: the tolerances from which the classes were made, in the same order.
nlohmann::ordered_json to_json(std::span<const RecallOfViews> classes);
nlohmann::ordered_json to_json(std::span<const RecallOfThickness> classes);
nlohmann::ordered_json to_json(std::span<const ErrorsOfViews> classes);
nlohmann::ordered_json to_json(const Calibration& calibration);
nlohmann::ordered_json to_json(const Strip& strip);

std::string table(std::span<const RecallOfViews> classes, std::span<const double> tolerances);
std::string table(std::span<const RecallOfThickness> classes, std::span<const double> tolerances);
std::string table(std::span<const ErrorsOfViews> classes, std::span<const double> tolerances);
std::string table(const Calibration& calibration);
std::string table(const Strip& strip);

}  // namespace axial::evaluate
