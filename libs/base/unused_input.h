// SPDX-License-Identifier: GPL-3.0-or-later
// Input that the user gave and that a program cannot use, because the data it refers to are
// missing.
#pragma once

#include <string>
#include <vector>

#include "base/option_list.h"

namespace axial {

// Treats unused input as an error, or where it is allowed as a warning.
class UnusedInput {
 public:
  // Adds the option --allow-missing to `list`, bound to `allowed`. `allowed` must exist until the
  // options have been parsed.
  static void declare(OptionList& list, bool& allowed);

  // For a program with this option.
  explicit UnusedInput(bool allowed);

  // For a library: `setting` is the name of the setting that allows unused input.
  UnusedInput(bool allowed, std::string setting);

  // Reports one unused input. `line` names the setting, the input and the reason. Throws an Error
  // with this line, or if allowed logs it as a warning and keeps it.
  void report(const std::string& line);

  // The lines of the warnings, in the order of the reports.
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  bool allowed_;
  std::string setting_;
  std::vector<std::string> lines_;
};

}  // namespace axial
