// SPDX-License-Identifier: GPL-3.0-or-later
// How far a stage is. Stages call the sink; programs decide what is shown.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace axial {

// Called by a stage with (items done, items in all), from one thread at a time. May be empty.
using ProgressSink = std::function<void(std::size_t done, std::size_t total)>;

// A sink that logs "<title> 3/10 (30%, 12s, 28s left)": rewritten in place on a terminal, plain
// lines at most every few seconds in a file. What is under way counts as debugging, the end of the
// stage as information: each is silent where the log is.
ProgressSink console_progress(const std::string& title);

}  // namespace axial
