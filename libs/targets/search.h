// SPDX-License-Identifier: GPL-3.0-or-later
// Targets in the photographs of a survey.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/context.h"
#include "targets/codes/family.h"
#include "targets/targets_file.h"

namespace axial::targets {

// A photograph and its name as COLMAP names images.
struct NamedPhotograph {
  std::filesystem::path file;
  std::string name;
};

// Finds the targets of `families` in all photographs, in their order. As many photographs are
// searched at a time as the memory of `context` and the threads allow. Error that names a
// photograph that cannot be read, or for which the memory does not suffice.
std::vector<Photograph> search_photographs(std::span<const NamedPhotograph> photographs,
                                           std::span<const Family> families,
                                           const Context& context = {});

}  // namespace axial::targets
