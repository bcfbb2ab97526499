// SPDX-License-Identifier: GPL-3.0-or-later
// Reports the evaluation of a mesh as text for people and as JSON for programs (fields:
// docs/evaluate.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "evaluate/mesh_evaluation.h"

namespace axial::evaluate {

// Returns an object with the fields "normals", "seen", "unseen" and "topology". The fields "seen"
// and "unseen" are absent if the evaluation has none, which means that there were no views. Lengths
// are metres, angles are degrees. The median of normals without angles is null.
nlohmann::ordered_json to_json(const MeshEvaluation& evaluation);

// Returns the evaluation as lines of text. Each line ends with a line break. Lengths are
// millimetres, angles are degrees.
std::string table(const MeshEvaluation& evaluation);

}  // namespace axial::evaluate
