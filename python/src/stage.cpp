// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/stage.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include "src/bind.h"

namespace axial::python {
namespace {

// How often signals are looked for.
constexpr std::chrono::milliseconds kPause(50);

// The events of a stage on their way from its thread to that of the caller.
class EventQueue {
 public:
  void add(const Event& event) {
    const std::lock_guard lock(mutex_);
    events_.push_back(event);
    changed_.notify_one();
  }

  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_one();
  }

  // Waits for events, for the end of the stage, or for kPause, whichever is first. Returns whether
  // the stage has ended.
  bool take(std::vector<Event>& events) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kPause, [&] { return closed_ || !events_.empty(); });
    events = std::exchange(events_, {});
    return closed_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Event> events_;
  bool closed_ = false;
};

// The level of a line in Python's logging.
const char* method_of(LogLevel level) {
  if (level == LogLevel::warning) return "warning";
  return level == LogLevel::info ? "info" : "debug";
}

// Gives an event to Python. Returns whether the stage may go on.
bool deliver(const Event& event, const py::object& progress) {
  if (event.kind == Event::Kind::line) {
    const py::object logger = py::module_::import("logging").attr("getLogger")("axialmvs");
    logger.attr(method_of(event.level))("%s", text_of_file_system(event.text));
    return true;
  }
  if (progress.is_none()) return true;
  const py::object answer = progress(text_of_file_system(event.text), event.done, event.total);
  return answer.ptr() != Py_False;
}

void deliver_all(const std::vector<Event>& events, const py::object& progress,
                 std::stop_source& stop) {
  for (const Event& event : events) {
    if (stop.stop_requested()) return;
    if (!deliver(event, progress)) stop.request_stop();
  }
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

// Handles events until the stage has ended. Returns the exception of Python that stopped it.
std::optional<py::error_already_set> attend(EventQueue& queue, const py::object& progress,
                                            std::stop_source& stop) {
  std::optional<py::error_already_set> raised;
  for (bool ended = false; !ended;) {
    std::vector<Event> events;
    {
      const py::gil_scoped_release unlocked;
      ended = queue.take(events);
    }
    try {
      if (!raised) deliver_all(events, progress, stop);
    } catch (py::error_already_set& error) {
      raised.emplace(error);
      stop.request_stop();
    }
  }
  return raised;
}

Limits limits_of(const StageControls& controls) {
  Limits limits;
  limits.memory = MemoryBudget::of_program(controls.max_memory);
  if (controls.max_threads > 0) limits.threads = controls.max_threads;
  return limits;
}

}  // namespace

void StageControls::add_to(Keywords& keywords) {
  keywords
      .add("progress",
           [this](const py::handle& value) {
             if (!value.is_none() && !PyCallable_Check(value.ptr()))
               throw py::type_error("progress: must be a function");
             progress = py::reinterpret_borrow<py::object>(value);
           })
      .add("max_memory", max_memory, 0, 0x1p40)
      .add("max_threads", max_threads, 0, 1024);
}

void run_stage(const StageControls& controls, const std::function<void(const Context&)>& work) {
  EventQueue queue;
  std::stop_source stop;
  std::exception_ptr failure;
  const Limits limits = limits_of(controls);
  std::thread worker([&] {
    try {
      const Context context([&](const Event& event) { queue.add(event); }, stop.get_token(),
                            limits);
      work(context);
    } catch (...) {
      failure = std::current_exception();
    }
    queue.close();
  });
  std::optional<py::error_already_set> raised;
  std::exception_ptr of_attending;
  try {
    raised = attend(queue, controls.progress, stop);
  } catch (...) {
    of_attending = std::current_exception();
    stop.request_stop();
  }
  {
    const py::gil_scoped_release unlocked;  // the stage may still call functions of Python
    worker.join();
  }
  if (of_attending) std::rethrow_exception(of_attending);
  if (raised) throw py::error_already_set(*raised);
  if (failure) std::rethrow_exception(failure);
}

void run_logged(const std::function<void(const Context&)>& work) {
  std::vector<Event> events;
  std::exception_ptr failure;
  {
    const py::gil_scoped_release unlocked;
    try {
      work(Context([&](const Event& event) { events.push_back(event); }));
    } catch (...) {
      failure = std::current_exception();
    }
  }
  for (const Event& event : events) deliver(event, py::none());
  if (failure) std::rethrow_exception(failure);
}

}  // namespace axial::python
