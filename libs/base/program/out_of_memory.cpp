// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/out_of_memory.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <new>
#include <string_view>

namespace axial {
namespace {

// A line of text that needs no further memory.
class Line {
 public:
  Line& add(std::string_view text) {
    for (const char byte : text)
      if (size_ + 1 < bytes_.size()) bytes_[size_++] = byte == '\n' ? ' ' : byte;
    return *this;
  }

  void write() {
    bytes_[size_++] = '\n';
    for (std::size_t begin = 0; begin < size_;) {
      const ssize_t written = ::write(STDERR_FILENO, &bytes_[begin], size_ - begin);
      if (written <= 0) return;
      begin += static_cast<std::size_t>(written);
    }
  }

 private:
  std::array<char, 500> bytes_{};
  std::size_t size_ = 0;
};

[[noreturn]] void report_and_end() {
  const std::exception_ptr uncaught = std::current_exception();
  if (!uncaught) std::abort();
  Line line;
  line.add(program_invocation_short_name).add(": ");
  try {
    std::rethrow_exception(uncaught);
  } catch (const std::exception& error) {
    line.add(is_out_of_memory(error) ? "out of memory" : error.what());
  } catch (...) {
    line.add("an exception of unknown type");
  }
  line.write();
  std::_Exit(1);  // without destructors of static objects, which other threads may still use
}

}  // namespace

bool is_out_of_memory(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error)) return true;
  const std::string_view text = error.what();
  for (const char* words :
       {"std::bad_alloc", "Cannot allocate memory", "Insufficient memory", "Failed to allocate"})
    if (text.find(words) != std::string_view::npos) return true;
  return false;
}

void report_uncaught_exceptions() {
  std::set_terminate(report_and_end);
}

}  // namespace axial
