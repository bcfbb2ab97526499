// SPDX-License-Identifier: GPL-3.0-or-later
// Fingerprints of inputs and options, and counter-based random numbers.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace axial {

// Collects bytes into a 128-bit XXH3 fingerprint. The fingerprint identifies the inputs from which
// a file was made. XXH3 was chosen for speed, because whole files are hashed. XXH3 does not protect
// against collisions that are made on purpose. The functions add() return the object itself.
class Fingerprint {
 public:
  Fingerprint();
  ~Fingerprint();

  // Adds the number of bytes and the bytes. So "ab", "c" gives another fingerprint than "a", "bc".
  Fingerprint& add(std::string_view bytes);
  // Adds the 8 bytes of `value`.
  Fingerprint& add(std::uint64_t value);
  // Adds the 8 bytes of `value`. So 0.0 gives another fingerprint than -0.0.
  Fingerprint& add(double value);
  // The fingerprint of all that was added so far, as 32 hex digits in lower case.
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// A bijective map of 64 bits to 64 bits (the splitmix64 finaliser). The result looks random. To get
// a random number that belongs to a tuple of integers, scramble them one after the other:
// scramble(scramble(image) ^ pixel). Such numbers do not depend on the order of evaluation.
constexpr std::uint64_t scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// Returns the upper 24 bits of `bits`, divided by 2^24: a number in [0, 1). If `bits` is uniformly
// distributed, so is the result.
constexpr float unit_float(std::uint64_t bits) {
  return static_cast<float>(bits >> 40) * (1.0f / 16777216.0f);
}

}  // namespace axial
