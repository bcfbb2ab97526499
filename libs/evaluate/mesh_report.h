// SPDX-License-Identifier: GPL-3.0-or-later
// Reports the evaluation of a mesh as text for people and as JSON for programs (fields:
// docs/evaluate.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "evaluate/mesh_evaluation.h"

namespace axial::evaluate {

// Returns an object with the fields "normals", "seen", "unseen" and "topology". Without cameras the
// fields "seen" and "unseen" are absent. Lengths are metres in the JSON and millimetres in the
// table.
nlohmann::ordered_json to_json(const MeshEvaluation& evaluation);

std::string table(const MeshEvaluation& evaluation);

}  // namespace axial::evaluate
