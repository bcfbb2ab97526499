// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace axial::view::testing {

// Reads little-endian numbers from bytes, one after the other. The processors of the tests are
// little-endian, too.
class ByteSource {
 public:
  explicit ByteSource(const std::string& bytes) : bytes_(bytes) {}

  template <class T>
  T take() {
    T value{};
    std::memcpy(&value, bytes_.substr(at_, sizeof(T)).data(), sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace axial::view::testing
