// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of a Context, for tests.
#pragma once

#include <string>

#include "base/context.h"

namespace axial::test {

struct CapturedEvents {
  std::string lines;  // of the levels `info` and `warning`, each with a newline at its end

  EventSink sink() {
    return [this](const Event& event) {
      if (event.kind == Event::Kind::line && event.level >= LogLevel::info)
        lines += event.text + "\n";
    };
  }

  const Context context{sink()};
};

}  // namespace axial::test
