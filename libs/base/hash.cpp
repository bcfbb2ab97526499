// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/hash.h"

#include <fmt/format.h>

#include <bit>
#include <boost/uuid/detail/sha1.hpp>

namespace axial {

struct Fingerprint::State {
  boost::uuids::detail::sha1 sha1;
};

Fingerprint::Fingerprint() : state_(std::make_unique<State>()) {}
Fingerprint::~Fingerprint() = default;

Fingerprint& Fingerprint::add(std::string_view bytes) {
  add(static_cast<std::uint64_t>(bytes.size()));
  state_->sha1.process_bytes(bytes.data(), bytes.size());
  return *this;
}

Fingerprint& Fingerprint::add(std::uint64_t value) {
  state_->sha1.process_bytes(&value, sizeof value);
  return *this;
}

Fingerprint& Fingerprint::add(double value) {
  return add(std::bit_cast<std::uint64_t>(value));
}

std::string Fingerprint::hex() const {
  boost::uuids::detail::sha1 copy = state_->sha1;
  unsigned digest[5];
  copy.get_digest(digest);
  return fmt::format("{:08x}{:08x}{:08x}{:08x}{:08x}", digest[0], digest[1], digest[2], digest[3],
                     digest[4]);
}

}  // namespace axial
