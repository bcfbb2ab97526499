// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/console.h"

#include <map>
#include <memory>
#include <string>

namespace axial {

EventSink console_events() {
  return [stages = std::make_shared<std::map<std::string, ProgressSink>>()](const Event& event) {
    if (event.kind == Event::Kind::line) {
      log_line(event.level, event.marked);
    } else if (event.total == 0) {
      (*stages)[event.text] = console_progress(event.text);
    } else {
      stages->at(event.text)(event.done, event.total);
    }
  };
}

}  // namespace axial
