// SPDX-License-Identifier: GPL-3.0-or-later
// What the user gave and a program finds no use for, because the data lack what it is of.
#pragma once

#include <string>
#include <vector>

#include "base/option_list.h"

namespace axial {

class UnusedInput {
 public:
  // Declares --allow-missing, bound to `allowed`, which must outlive the parsing.
  static void declare(OptionList& list, bool& allowed);

  explicit UnusedInput(bool allowed) : allowed_(allowed) {}

  // `line` names the option, what was given and why it is of no use: an Error of this line, or
  // where it is allowed a warning, and the program goes on without what was given.
  void report(const std::string& line);

  // What was reported, in its order.
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  bool allowed_;
  std::vector<std::string> lines_;
};

}  // namespace axial
