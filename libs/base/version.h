// SPDX-License-Identifier: GPL-3.0-or-later
// The version of the programs. version.cpp is a separate build target (axial_version), because the
// version changes with every commit to the sources. Only programs link this target.
#pragma once

#include <string>

namespace axial {

// The line that --version prints, for example "DensifyPointCloud 0.2.0, commit 1ca1f70, instruction
// sets: SSE2, AVX2, AVX-512". It consists of the name of the program, the version (project(VERSION)
// in CMakeLists.txt), the commit that last changed the sources, and the instruction sets for which
// matching is compiled. A "+" after the commit means that the sources have changes that are not
// committed. The commit is "unknown" for a build outside git.
std::string version_line(const std::string& program);

}  // namespace axial
