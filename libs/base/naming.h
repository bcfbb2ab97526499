// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "base/error.h"

namespace axial {

// Calls `work` and returns its result. If `work` throws an Error whose message begins with neither
// a file nor a setting, throws an Error of `file` with this message instead. For functions that do
// not know which file they work on.
template <class Work>
auto naming(const std::filesystem::path& file, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    if (!error.file().empty() || !error.setting().empty()) throw;
    fail_in(file, "{}", error.text());
  }
}

}  // namespace axial
