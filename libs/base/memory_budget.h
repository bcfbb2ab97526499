// SPDX-License-Identifier: GPL-3.0-or-later
// The memory that work may use. A program makes one budget from its option --max-memory
// (program_context() in base/program.h). The budget travels in the Context (base/context.h). The
// functions that tell how much memory a stage needs stand beside the stage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace axial {

inline constexpr std::uint64_t kMegabyte = 1'000'000;  // the unit of options in megabytes [bytes]

// The bytes of code and libraries, stacks and small blocks of a program.
inline constexpr std::uint64_t kProgramBytes = 96 * kMegabyte;

// Copies of a budget have a common count of reservations. All functions may be called from several
// threads at the same time.
class MemoryBudget {
  struct State;

 public:
  // Bytes of a budget that are in use as long as this object exists.
  class Reservation {
   public:
    Reservation() = default;  // of no bytes
    Reservation(std::shared_ptr<State> state, std::uint64_t bytes);
    Reservation(Reservation&& other) noexcept;
    Reservation& operator=(Reservation&& other) noexcept;
    ~Reservation();

   private:
    std::shared_ptr<State> state_;
    std::uint64_t bytes_ = 0;
  };

  // Without a limit.
  MemoryBudget() = default;

  // The budget of a whole program: `megabytes` megabytes, or, for 0, 70 % of the memory that is now
  // available or used by this process. What the process uses at the time of a call is in use, at
  // least `program_bytes`, so that a program that has just begun decides like one that has loaded
  // all of its code. `setting`: the name of `megabytes` in messages. Throws an Error that names the
  // setting for 0 megabytes if the system does not report how much memory is available.
  static MemoryBudget of_program(std::uint64_t megabytes, std::string setting = "max_memory",
                                 std::uint64_t program_bytes = kProgramBytes);

  // A budget of `bytes` bytes. Only reservations are in use, so that decisions do not depend on
  // what the process uses.
  static MemoryBudget of_bytes(std::uint64_t bytes, std::string setting = "max_memory");

  // The budget of a stage that counts its own memory: of_bytes(left()) for the budget of a program;
  // another budget itself.
  MemoryBudget share() const;

  // The same budget, with errors of require() that end with `advice`.
  MemoryBudget with_advice(std::string advice) const;

  bool is_limited() const { return state_ != nullptr; }

  // The next four are for a budget that has a limit.
  const std::string& setting() const;
  std::uint64_t megabytes() const;      // of_program(): as given, also 0
  std::uint64_t program_bytes() const;  // of_bytes(): 0
  std::uint64_t limit() const;          // [bytes]

  // The bytes between the use and the limit. 0 if the use is at the limit; the largest number if
  // there is no limit.
  std::uint64_t left() const;

  // Throws an Error if `bytes` are more than left(). The message is one line. It begins with the
  // setting. For the budget of a program, it tells how many megabytes the program needs for `work`;
  // otherwise, how many more megabytes `work` needs.
  void require(std::uint64_t bytes, const std::string& work) const;

  // How many items of `each` bytes, at least 1 and at most `most`, can be in memory at the same
  // time. Throws the Error of require() if there is no room for one.
  std::size_t items(std::uint64_t each, std::size_t most, const std::string& work) const;

  // Takes `bytes` of what is left, even if less is left.
  [[nodiscard]] Reservation reserve(std::uint64_t bytes) const;
  // The same after require().
  [[nodiscard]] Reservation reserve(std::uint64_t bytes, const std::string& work) const;

 private:
  std::shared_ptr<State> state_;  // null: no limit
  std::string advice_;
};

}  // namespace axial
