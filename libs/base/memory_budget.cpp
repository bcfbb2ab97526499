// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "axial/base.h"
#include "base/error.h"
#include "base/memory.h"

namespace axial {

namespace {

// The memory that this process uses is not available any more, but it belongs to the limit.
std::uint64_t limit_of(std::uint64_t megabytes) {
  if (megabytes > 0) return megabytes * kMegabyte;
  try {
    return available_memory() / 10 * 7 + resident_memory() / 10 * 7;
  } catch (const Error& error) {
    fail("{}; give {}", error.text(), setting("max_memory"));
  }
}

}  // namespace

struct MemoryBudget::State {
  std::uint64_t limit = 0, megabytes = 0, program_bytes = 0;
  bool is_program = false;
  std::atomic<std::uint64_t> reserved = 0;

  std::uint64_t used() const {
    return reserved + (is_program ? std::max(resident_memory(), program_bytes) : 0);
  }
};

MemoryBudget::Reservation::Reservation(std::shared_ptr<State> state, std::uint64_t bytes)
    : state_(std::move(state)), bytes_(bytes) {
  if (state_) state_->reserved += bytes_;
}

MemoryBudget::Reservation::Reservation(Reservation&& other) noexcept
    : state_(std::move(other.state_)), bytes_(other.bytes_) {}

MemoryBudget::Reservation& MemoryBudget::Reservation::operator=(Reservation&& other) noexcept {
  std::swap(state_, other.state_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

MemoryBudget::Reservation::~Reservation() {
  if (state_) state_->reserved -= bytes_;
}

MemoryBudget MemoryBudget::of_program(std::uint64_t megabytes, std::uint64_t program_bytes) {
  MemoryBudget budget = of_bytes(limit_of(megabytes));
  budget.state_->megabytes = megabytes;
  budget.state_->program_bytes = program_bytes;
  budget.state_->is_program = true;
  return budget;
}

MemoryBudget MemoryBudget::of_bytes(std::uint64_t bytes) {
  MemoryBudget budget;
  budget.state_ = std::make_shared<State>();
  budget.state_->limit = bytes;
  budget.state_->megabytes = bytes / kMegabyte;
  return budget;
}

MemoryBudget MemoryBudget::share() const {
  return state_ && state_->is_program ? of_bytes(left()) : *this;
}

MemoryBudget MemoryBudget::with_advice(std::string advice) const {
  MemoryBudget copy = *this;
  copy.advice_ = std::move(advice);
  return copy;
}

std::uint64_t MemoryBudget::megabytes() const {
  return state_->megabytes;
}

std::uint64_t MemoryBudget::program_bytes() const {
  return state_->program_bytes;
}

std::uint64_t MemoryBudget::limit() const {
  return state_->limit;
}

std::uint64_t MemoryBudget::left() const {
  if (!state_) return std::numeric_limits<std::uint64_t>::max();
  return state_->limit - std::min(state_->limit, state_->used());
}

void MemoryBudget::require(std::uint64_t bytes, const std::string& work) const {
  if (!state_) return;
  const std::uint64_t needed = state_->used() + bytes, limit = state_->limit;
  if (needed <= limit) return;
  const std::string name = setting("max_memory");
  if (state_->is_program)
    fail("{}: {} MB are too little, {} needs {} MB{}", name, limit / kMegabyte, work,
         needed / kMegabyte + 1, advice_);
  fail("{}: {} needs {} MB more{}", name, work, (needed - limit) / kMegabyte + 1, advice_);
}

std::size_t MemoryBudget::items(std::uint64_t each, std::size_t most,
                                const std::string& work) const {
  require(each, work);
  const std::uint64_t fit = left() / std::max<std::uint64_t>(each, 1);
  return static_cast<std::size_t>(
      std::clamp<std::uint64_t>(fit, 1, std::max<std::size_t>(most, 1)));
}

MemoryBudget::Reservation MemoryBudget::reserve(std::uint64_t bytes) const {
  return {state_, bytes};
}

MemoryBudget::Reservation MemoryBudget::reserve(std::uint64_t bytes,
                                                const std::string& work) const {
  require(bytes, work);
  return reserve(bytes);
}

}  // namespace axial
