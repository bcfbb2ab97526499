// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/quiet_errors.h"

#include <cstddef>
#include <iostream>
#include <new>
#include <streambuf>

namespace axial {
namespace {

thread_local bool is_quiet = false;

class Filter : public std::streambuf {
 public:
  explicit Filter(std::streambuf* to) : to_(to) {}

 private:
  int overflow(int c) override {
    if (is_quiet || c == traits_type::eof()) return traits_type::not_eof(c);
    return to_->sputc(traits_type::to_char_type(c));
  }
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    return is_quiet ? size : to_->sputn(text, size);
  }
  int sync() override { return to_->pubsync(); }

  std::streambuf* to_;
};

}  // namespace

void filter_errors() {
  // Never destroyed: std::cerr is flushed after the destructors of static objects.
  alignas(Filter) static std::byte place[sizeof(Filter)];
  [[maybe_unused]] static const auto* before =
      std::cerr.rdbuf(new (place) Filter(std::cerr.rdbuf()));
}

QuietErrors::QuietErrors() {
  is_quiet = true;
}

QuietErrors::~QuietErrors() {
  is_quiet = false;
}

}  // namespace axial
