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

// Collects bytes into a 128-bit XXH3 fingerprint, printed as 32 hex digits. It identifies the
// inputs from which a file was made. It is chosen for speed, since it reads whole files, and is not
// secure against intended collisions.
class Fingerprint {
 public:
  Fingerprint();
  ~Fingerprint();

  Fingerprint& add(std::string_view bytes);  // length-prefixed, so that "ab"+"c" is not "a"+"bc"
  Fingerprint& add(std::uint64_t value);
  Fingerprint& add(double value);
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// A bijective scramble of 64 bits (the splitmix64 finaliser). It gives random numbers from a key
// such as (image, pixel, sweep, trial), so that they do not depend on the order of evaluation.
constexpr std::uint64_t scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// A number in [0, 1) from the upper 24 bits. It is uniform if the bits are.
constexpr float unit_float(std::uint64_t bits) {
  return static_cast<float>(bits >> 40) * (1.0f / 16777216.0f);
}

}  // namespace axial
