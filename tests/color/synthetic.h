// SPDX-License-Identifier: GPL-3.0-or-later
// Observations of surface points by a formula of their light.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>
#include <vector>

#include "color/observations.h"

namespace axial::color::test {

struct Synthetic {
  Observations observations;
  std::vector<Eigen::Array3f> surfaces;  // J of the points
};

// `seen(sight, J)`: the light of a point. Each point is in six of `views` photographs, at random
// places, normals and directions, and at ways from `nearest` to `farthest` [m]. `noise`: the
// standard deviation as a share of the light.
inline Synthetic synthetic(
    std::size_t points, float nearest, float farthest, double noise, unsigned seed,
    const std::function<Eigen::Array3f(const Sight&, const Eigen::Array3f&)>& seen,
    std::uint32_t views = 24) {
  constexpr int kSeen = 6;
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * (static_cast<double>(random()) / 4294967296.0));
  };
  std::normal_distribution<float> normal;
  Synthetic result;
  result.observations.first.push_back(0);
  for (std::uint32_t point = 0; point < points; ++point) {
    Eigen::Array3f surface;
    for (const int k : {2, 1, 0}) surface[k] = uniform(0.05, 0.5);
    result.surfaces.push_back(surface);
    const auto first_view = static_cast<std::uint32_t>(random() % views);
    for (std::uint32_t i = 0; i < kSeen; ++i) {
      Observation one;
      one.point = point;
      one.view = (first_view + i) % views;
      const auto towards_camera = [&](double half) {
        const float y = uniform(-half, half);
        return Eigen::Vector3f(uniform(-half, half), y, -1).normalized();
      };
      one.sight = {{uniform(-1, 1), uniform(-0.75, 0.75)},
                   uniform(nearest, farthest),
                   towards_camera(0.5),
                   towards_camera(0.6)};
      one.light = seen(one.sight, surface);
      for (int k = 0; k < 3; ++k) one.light[k] *= 1 + static_cast<float>(noise) * normal(random);
      one.spread.setZero();
      result.observations.all.push_back(one);
    }
    result.observations.first.push_back(result.observations.all.size());
  }
  return result;
}

inline Eigen::Array3f in_plain_water(const Sight& sight, const Eigen::Array3f& surface) {
  const Eigen::Array3f a(0.6f, 0.3f, 0.2f), b(0.5f, 0.25f, 0.2f), veil(0.05f, 0.2f, 0.25f);
  return surface * (-a * sight.way).exp() + veil * (1 - (-b * sight.way).exp());
}

// Two lamps beside the camera, in water that loses light at the rates c, and a veil.
inline Eigen::Array3f in_light_of_lamps(const Sight& sight, const Eigen::Array3f& surface) {
  const Eigen::Array3f c(0.5f, 0.35f, 0.3f);
  const Eigen::Vector3f point(sight.place.x() * sight.way, sight.place.y() * sight.way, sight.way);
  Eigen::Array3f light = Eigen::Array3f::Zero();
  for (const float side : {-0.4f, 0.3f}) {
    const Eigen::Vector3f way = Eigen::Vector3f(side, -0.1f, 0) - point;
    const float distance = way.norm();
    const float facing = std::max(0.0f, sight.normal.dot(way) / distance);
    const float cone = 1 - 0.3f * (sight.place.x() - side) * (sight.place.x() - side);
    light += facing * cone / (distance * distance) * (-c * (distance + sight.way)).exp();
  }
  const float wide = 1 - 0.2f * sight.place.squaredNorm();
  return surface * light + wide * Eigen::Array3f(0.01f, 0.02f, 0.03f);
}

}  // namespace axial::color::test
