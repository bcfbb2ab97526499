// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/parsed_options.h"

namespace axial {

bool given(const ParsedOptions& parsed, const std::string& name) {
  return parsed.given.contains(name);
}

std::filesystem::path in_working_folder(const CommonOptions& common, const std::string& path) {
  if (path.empty()) return {};
  return (common.working_folder / path).lexically_normal();
}

}  // namespace axial
