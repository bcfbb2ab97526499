// SPDX-License-Identifier: GPL-3.0-or-later
// The random numbers of PatchMatch.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/hash.h"

namespace axial::depth {

// Random numbers for one key, which consists of image, pixel and sweep. A new object with the same
// key gives the same values in the same sequence of calls. So results do not depend on the number
// of threads or on the order of pixels.
class KeyedRandom {
 public:
  KeyedRandom(std::uint64_t image, std::uint64_t pixel, std::uint64_t sweep)
      : key_(scramble(scramble(scramble(image) ^ pixel) ^ sweep)) {}

  float unit() { return unit_float(scramble(key_ + ++count_)); }  // uniform in [0, 1)

  // A random unit normal that faces the camera, uniform over the directions within 80 degrees of
  // -ray_direction. Precondition: ray_direction has unit length.
  Eigen::Vector3f facing_normal(const Eigen::Vector3f& ray_direction) {
    const float cosine = 1.0f - unit() * (1.0f - 0.17365f);
    return tilted(-ray_direction, cosine, unit());
  }

  // Three independent numbers, uniform over the multiples of 2^-20 in [-1, 1).
  std::array<float, 3> symmetric_triple() {
    const std::uint64_t bits = scramble(key_ + ++count_);
    const auto part = [bits](int shift) {
      return static_cast<float>(static_cast<std::int32_t>((bits >> shift & 0x1FFFFF)) - (1 << 20)) *
             (1.0f / (1 << 20));
    };
    return {part(43), part(22), part(1)};
  }

 private:
  static Eigen::Vector3f tilted(const Eigen::Vector3f& axis, float cosine, float turn) {
    const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
    const float azimuth = 2 * std::numbers::pi_v<float> * turn;
    const Eigen::Vector3f u = axis.unitOrthogonal();
    const Eigen::Vector3f v = axis.cross(u);
    return (axis * cosine + (u * std::cos(azimuth) + v * std::sin(azimuth)) * sine).normalized();
  }

  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

}  // namespace axial::depth
