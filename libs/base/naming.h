// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

namespace axial {

// An Error whose message names its file already.
class NamedError : public Error {
 public:
  using Error::Error;
};

// Calls `work` and returns its result. An Error of `work` becomes a NamedError with the same
// message.
template <class Work>
auto already_named(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw NamedError(error.what());
  }
}

// Calls `work` and returns its result. If `work` throws an Error, throws an Error with the message
// "<file>: <message of work>" instead. Exception: a NamedError, and a message that begins with an
// option ("--") or with an absolute path, stay as they are. For functions that do not know which
// file they work on.
template <class Work>
auto naming(const std::filesystem::path& file, const Work& work) {
  try {
    return work();
  } catch (const NamedError&) {
    throw;
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.starts_with("--") || message.starts_with("/")) throw;
    fail("{}: {}", file.string(), message);
  }
}

}  // namespace axial
