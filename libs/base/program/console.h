// SPDX-License-Identifier: GPL-3.0-or-later
// How a program shows the events of its stages.
#pragma once

#include "base/context.h"

namespace axial {

// Returns a sink that writes lines to the log (base/log.h), and the progress of stages as
// console_progress() does (base/progress.h).
EventSink console_events();

}  // namespace axial
