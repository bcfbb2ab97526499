// SPDX-License-Identifier: GPL-3.0-or-later
// Input that the user gave, but that a program cannot use because it refers to missing data.
#pragma once

#include <string>
#include <vector>

#include "axial/base.h"
#include "base/program/option_list.h"

namespace axial {

// Reports unused input. If unused input is allowed, a report is a warning, otherwise an error.
class UnusedInput {
 public:
  // Adds the option --allow-missing to `list`, bound to `allowed`, whose present value is the
  // default. `allowed` must exist until the options have been parsed.
  static void declare(OptionList& list, bool& allowed);

  // `allowed`: the value of the setting "allow_missing".
  explicit UnusedInput(bool allowed) : allowed_(allowed) {}

  // Reports one unused input. `line` names the setting, the input and the reason. If unused input
  // is allowed, warns through `context`, in a line that begins with `line`, and keeps `line` for
  // lines(). Otherwise throws an Error whose message begins with `line` and names the setting that
  // allows unused input.
  void report(const std::string& line, const Context& context);

  // The lines that were reported as warnings, as the log has them, in the order of the reports.
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  bool allowed_;
  std::vector<std::string> lines_;
};

}  // namespace axial
