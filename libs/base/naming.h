// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

namespace axial {

// Calls `work` and returns its result. If `work` throws an Error, throws an Error with the message
// "<file>: <message of work>" instead. Exception: a message that begins with an option ("--") or
// with an absolute path stays as it is. For functions that do not know which file they work on.
template <class Work>
auto naming(const std::filesystem::path& file, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.starts_with("--") || message.starts_with("/")) throw;
    fail("{}: {}", file.string(), message);
  }
}

}  // namespace axial
