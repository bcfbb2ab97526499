// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/version.h"

#include <fmt/format.h>

#include "axial_commit.h"  // written by cmake/write_commit.cmake

namespace axial {

std::string version_line(const std::string& program) {
  return fmt::format("{} {}, commit {}, instruction sets: {}", program, AXIAL_VERSION, AXIAL_COMMIT,
                     AXIAL_INSTRUCTION_SETS);
}

}  // namespace axial
