// SPDX-License-Identifier: GPL-3.0-or-later
// Reports evaluations as text for people and as JSON for programs (fields: docs/evaluate.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "evaluate/alignment.h"
#include "evaluate/cloud_evaluation.h"
#include "evaluate/depth_evaluation.h"

namespace axial::evaluate {

// Lengths are metres in the JSON and millimetres in the tables.
nlohmann::ordered_json to_json(const CloudEvaluation& evaluation);
nlohmann::ordered_json to_json(const DepthEvaluation& evaluation);
nlohmann::ordered_json to_json(const Similarity& similarity);

std::string table(const CloudEvaluation& evaluation);
std::string table(const DepthEvaluation& evaluation);

}  // namespace axial::evaluate
