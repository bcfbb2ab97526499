// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/hash.h"

namespace axial::depth {

// Random numbers keyed by image, pixel and sweep: the n-th number of a key is always the same,
// whichever thread asks and whatever was asked before.
class KeyedRandom {
 public:
  KeyedRandom(std::uint64_t image, std::uint64_t pixel, std::uint64_t sweep)
      : key_(scramble(scramble(scramble(image) ^ pixel) ^ sweep)) {}

  float unit() { return unit_float(scramble(key_ + ++count_)); }  // [0, 1)
  float symmetric() { return 2.0f * unit() - 1.0f; }              // [-1, 1)

  // A normal facing the camera, uniform over the directions at most 80 degrees off the ray.
  Eigen::Vector3f facing_normal(const Eigen::Vector3f& ray_direction) {
    const float cosine = 1.0f - unit() * (1.0f - 0.17365f);
    return tilted(-ray_direction, cosine, unit());
  }

  // `normal` turned by up to `angle` radians in a random direction.
  Eigen::Vector3f turned(const Eigen::Vector3f& normal, float angle) {
    const float tilt = angle * std::sqrt(unit());
    return tilted(normal, std::cos(tilt), unit());
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
