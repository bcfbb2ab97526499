// SPDX-License-Identifier: GPL-3.0-or-later
// The version of the programs. A target of its own (axial_version), because it changes with every
// commit to the sources: only programs link it.
#pragma once

#include <string>

namespace axial {

// The line that --version prints: program, version (project(VERSION) in CMakeLists.txt), the commit
// that last changed the sources ("+": with changes that are not committed; "unknown": built outside
// git), and the instruction sets that matching is compiled for. For example "DensifyPointCloud
// 0.1.0, commit 1ca1f70, instruction sets: SSE2, AVX2, AVX-512".
std::string version_line(const std::string& program);

}  // namespace axial
