// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/unused_input.h"

#include "base/error.h"
#include "base/log.h"

namespace axial {

void UnusedInput::declare(OptionList& list, bool& allowed) {
  list.add_switch("allow-missing", &allowed,
                  "continue with a warning if a given input cannot be used");
}

void UnusedInput::report(const std::string& line, const Context& context) {
  if (!allowed_) fail("{} ({} continues without it)", line, setting("allow_missing"));
  context.warning("{}; it is not used", line);
  lines_.push_back(log_words(line));
}

}  // namespace axial
