// SPDX-License-Identifier: GPL-3.0-or-later
// The progress of a stage. Stages call a sink; programs choose the sink.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace axial {

// A stage calls it with the number of items done and of all items, from one thread at a time. May
// be empty.
using ProgressSink = std::function<void(std::size_t done, std::size_t total)>;

// A sink that writes "<title> 3/10 (30%, 12s, 28s left)". On a terminal it overwrites the same
// line; otherwise it logs a line every 5 seconds at most. Progress has the log level debug, the end
// of the stage the level info. The sink writes nothing at a level that the log does not write.
ProgressSink console_progress(const std::string& title);

}  // namespace axial
