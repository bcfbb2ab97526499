// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of an evaluation by numbers of views, thickness, expected error and along a strip: as
// text for people and as JSON for programs (fields: docs/evaluate.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "evaluate/places.h"
#include "evaluate/point_worth.h"
#include "evaluate/strip.h"

namespace axial::evaluate {

// Recall of classes without places, and errors of classes without points, are null. Lengths in the
// JSON are metres, in the tables millimetres. `tolerances`: those of the shares, in their order.
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
