// SPDX-License-Identifier: GPL-3.0-or-later
// Reports evaluations as text for people and as JSON for programs (fields: docs/evaluate.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "evaluate/alignment.h"
#include "evaluate/cloud_evaluation.h"
#include "evaluate/depth_evaluation.h"

namespace axial::evaluate {

// Return an object of statistics, without the values of single points and pixels. Lengths are
// metres.
nlohmann::ordered_json to_json(const CloudEvaluation& evaluation);
nlohmann::ordered_json to_json(const DepthEvaluation& evaluation);

// Returns the homogeneous 4 x 4 matrix as a list of four rows.
nlohmann::ordered_json to_json(const Similarity& similarity);

// Return the main statistics as lines of text, each with a line break at the end. Lengths are
// millimetres.
std::string table(const CloudEvaluation& evaluation);
std::string table(const DepthEvaluation& evaluation);

}  // namespace axial::evaluate
