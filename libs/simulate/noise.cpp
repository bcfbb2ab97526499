// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/hash.h"
#include "simulate/noise_corners.h"

namespace axial::simulate {
namespace {

std::uint32_t lattice_hash(std::uint32_t h) {
  h ^= h >> 16;
  h *= detail::kHashFactors[0];
  h ^= h >> 15;
  h *= detail::kHashFactors[1];
  return h ^ (h >> 16);
}

float fade(float t) {
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

// The largest integer that is not above v. (On the oldest supported processors std::floor is a
// function call.)
std::int64_t lattice(double v) {
  const auto truncated = static_cast<std::int64_t>(v);
  return truncated - (v < static_cast<double>(truncated) ? 1 : 0);
}

}  // namespace

namespace detail {

std::array<float, 8> corners_scalar(const NoiseCell& cell) {
  std::array<float, 8> values;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t dx = i & 1u, dy = (i >> 1) & 1u, dz = i >> 2;
    const std::uint32_t key = (cell.hash[0] + dx * kHashSteps[0]) ^
                              (cell.hash[1] + dy * kHashSteps[1]) ^
                              (cell.hash[2] + dz * kHashSteps[2]) ^ cell.seed;
    const std::uint32_t h = lattice_hash(key);
    const auto component = [h](int shift) {
      return static_cast<float>(static_cast<int>((h >> shift) & 1023u)) * kGradientStep - 1.0f;
    };
    values[i] = component(0) * (cell.offset[0] - static_cast<float>(dx)) +
                component(10) * (cell.offset[1] - static_cast<float>(dy)) +
                component(20) * (cell.offset[2] - static_cast<float>(dz));
  }
  return values;
}

CornersFunction fastest_corners() {
  return __builtin_cpu_supports("avx2") ? corners_avx2 : corners_scalar;
}

}  // namespace detail

float gradient_noise(const Eigen::Vector3d& p, std::uint32_t seed) {
  static const detail::CornersFunction corners = detail::fastest_corners();
  detail::NoiseCell cell{{}, {}, seed};
  for (std::size_t k = 0; k < 3; ++k) {
    const double v = p(static_cast<Eigen::Index>(k));
    const std::int64_t floored = lattice(v);
    cell.hash[k] = static_cast<std::uint32_t>(floored) * detail::kHashSteps[k];
    cell.offset[k] = static_cast<float>(v - static_cast<double>(floored));
  }
  const std::array<float, 8> value = corners(cell);
  const float u = fade(cell.offset[0]), v = fade(cell.offset[1]), w = fade(cell.offset[2]);
  const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
  const float bottom = mix(mix(value[0], value[1], u), mix(value[2], value[3], u), v);
  const float top = mix(mix(value[4], value[5], u), mix(value[6], value[7], u), v);
  return mix(bottom, top, w);
}

Eigen::Vector3d turn_octave(const Eigen::Vector3d& p) {
  // Two rotations with the sides of 3-4-5 and 5-12-13 triangles are exact without sin and cos.
  const double x = 0.8 * p.x() - 0.6 * p.y();
  const double y = 0.6 * p.x() + 0.8 * p.y();
  const double t = (5.0 * y - 12.0 * p.z()) / 13.0;
  const double z = (12.0 * y + 5.0 * p.z()) / 13.0;
  return {t + 19.19, z - 7.43, x + 31.71};
}

float fractal_noise(const Eigen::Vector3d& p, std::uint32_t seed, int octaves, float gain) {
  Eigen::Vector3d q = p;
  float sum = 0, weight = 1;
  for (int k = 0; k < octaves; ++k) {
    sum += weight * gradient_noise(q, seed + static_cast<std::uint32_t>(k) * 0x9e3779b9u);
    q = turn_octave(2.0 * q);
    weight *= gain;
  }
  return sum;
}

float smooth_step(float a, float b, float x) {
  const float t = std::clamp((x - a) / (b - a), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

double uniform(std::uint64_t seed, std::uint64_t index) {
  return static_cast<double>(scramble(scramble(seed) + index) >> 11) * 0x1p-53;
}

}  // namespace axial::simulate
