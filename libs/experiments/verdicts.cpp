// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/verdicts.h"

#include "experiments/tables.h"

namespace axial::experiments {

std::string verdict_table(const std::vector<Verdict>& verdicts) {
  std::vector<std::vector<std::string>> rows{{"asked", "seen", "met"}};
  for (const Verdict& verdict : verdicts)
    rows.push_back({verdict.asked, verdict.seen, verdict.met ? "yes" : "no"});
  return markdown_table(rows);
}

}  // namespace axial::experiments
