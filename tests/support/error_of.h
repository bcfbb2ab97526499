// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/error.h"

namespace axial::test {

// Returns the message of the Error that `run` throws. If `run` throws nothing, the test fails and
// the result is empty. Any other exception ends the test.
template <class Run>
std::string error_of(Run run) {
  try {
    run();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no Error";
  return {};
}

// The same, with each setting of the message in angle brackets: "<max_memory>: ...".
template <class Run>
std::string bracketed_error_of(Run run) {
  const std::string marks = setting("");
  try {
    run();
  } catch (const Error& error) {
    std::string text = error.text();
    std::ranges::replace(text, marks[0], '<');
    std::ranges::replace(text, marks[1], '>');
    return text;
  }
  ADD_FAILURE() << "no Error";
  return {};
}

}  // namespace axial::test
