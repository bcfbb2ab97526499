// SPDX-License-Identifier: GPL-3.0-or-later
// Requirements on the numbers of an experiment, and whether the numbers meet the requirements.
#pragma once

#include <string>
#include <vector>

namespace axial::experiments {

// One requirement. The texts are cells of a Markdown table, so they contain no "|" or line break.
struct Verdict {
  std::string asked;  // the requirement, in words
  std::string seen;   // the numbers of the experiment, in words
  bool met = false;
};

// Returns a Markdown table with one row for each requirement, in the order of `verdicts`.
std::string verdict_table(const std::vector<Verdict>& verdicts);

}  // namespace axial::experiments
