// SPDX-License-Identifier: GPL-3.0-or-later
// A file that keeps the state of a refinement, so that a run that was killed can go on.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "axial/refine.h"
#include "base/context.h"

namespace axial::refine {

// Returns a fingerprint of everything that the result of refine() depends on: all options except
// bytes_afterwards, `mesh`, and `views`, which is itself a fingerprint of the cameras, poses
// and pixels of all views.
std::string fingerprint(const Mesh& mesh, const Options& options, const std::string& views);

// Writes `state` to `file`, which is replaced at once or not at all. `fingerprint`: the result of
// fingerprint() for the mesh from which the refinement began. Error if the file cannot be written.
void write_state(const std::filesystem::path& file, const State& state,
                 const std::string& fingerprint);

// Returns the state that write_state() wrote with the same fingerprint. Returns nothing if there is
// no such file, if it has another fingerprint, or if it is damaged.
std::optional<State> read_state(const std::filesystem::path& file, const std::string& fingerprint);

// The file of the state of a run. A state that this run wrote is removed if the run ends with an
// error: the next run would meet the same error. It is kept if a file cannot be written, because
// the run can continue when this is mended. The state of a run that is stopped, or of an earlier,
// killed run, is kept, too.
class StateOfRun {
 public:
  // `context` gets the warning. It must exist as long as the object.
  StateOfRun(std::filesystem::path file, const Context& context)
      : file_(std::move(file)), context_(context) {}
  // Removes the state if write() has written it and writing() has thrown nothing.
  ~StateOfRun();
  StateOfRun(const StateOfRun&) = delete;
  StateOfRun& operator=(const StateOfRun&) = delete;

  // write_state().
  void write(const State& state, const std::string& fingerprint);

  // Calls `write`, which writes a file of the run. If it throws, the state is kept, and a warning
  // names it.
  void writing(const std::function<void()>& write);

  void remove() const;  // at the end of a run

 private:
  std::filesystem::path file_;
  const Context& context_;
  bool is_removed_ = false;
};

}  // namespace axial::refine
