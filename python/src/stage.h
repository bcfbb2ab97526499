// SPDX-License-Identifier: GPL-3.0-or-later
// Runs functions of the libraries for Python: with lines for Python's logging, and stages also with
// progress and a stop.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <functional>
#include <type_traits>

#include "axial/base.h"
#include "src/keywords.h"

namespace axial::python {

// The keywords that all stages have.
struct StageControls {
  py::object progress = py::none();  // a function of title, done and total
  std::uint64_t max_memory = 0;      // [MB]; 0: 70 % of the free memory
  unsigned max_threads = 0;          // 0: as many as cores

  void add_to(Keywords& keywords);
};

// Calls `work` in a thread of its own and returns when it has ended. In the meantime, the thread of
// the caller calls `progress` and writes the lines of the stage to Python's logger "axialmvs".
//
// A signal (KeyboardInterrupt), an exception of `progress` and the result False of `progress`
// request a stop of the stage. After the stage has ended, the exception is passed on. Stopped is
// thrown if the work was left undone because of False. Other exceptions of `work` are passed on.
//
// `work` runs without Python's lock. It takes the lock to call Python.
void run_stage(const StageControls& controls, const std::function<void(const Context&)>& work);

// Calls `work` without Python's lock, for work that is too short for a stage. Then writes the lines
// of `work` to Python's logger "axialmvs", also if `work` throws.
void run_logged(const std::function<void(const Context&)>& work);

// The same for work with a result, which is returned.
template <class Work>
auto logged(Work work) {
  std::invoke_result_t<Work, const Context&> result;
  run_logged([&](const Context& context) { result = work(context); });
  return result;
}

}  // namespace axial::python
