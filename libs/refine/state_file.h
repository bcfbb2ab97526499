// SPDX-License-Identifier: GPL-3.0-or-later
// A file that keeps the state of a refinement, so that a run that was killed can go on.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "refine/refine.h"

namespace axial::refine {

// Returns a fingerprint of everything that the result of refine() depends on: all options except
// max_bytes and name_of, `mesh`, and `views`, which is itself a fingerprint of the cameras, poses
// and pixels of all views.
std::string fingerprint(const Mesh& mesh, const Options& options, const std::string& views);

// Writes `state` to `file`, which is replaced at once or not at all. `fingerprint`: the result of
// fingerprint() for the mesh from which the refinement began. Error if the file cannot be written.
void write_state(const std::filesystem::path& file, const State& state,
                 const std::string& fingerprint);

// Returns the state that write_state() wrote with the same fingerprint. Returns nothing if there is
// no such file, if it has another fingerprint, or if it is damaged.
std::optional<State> read_state(const std::filesystem::path& file, const std::string& fingerprint);

}  // namespace axial::refine
