// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/hash.h"

namespace axial::simulate {
namespace {

std::uint32_t lattice_hash(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  return h ^ (h >> 16);
}

// Dot product of the offset with a gradient whose components are uniform in [-1, 1].
float corner(std::uint32_t h, float x, float y, float z) {
  constexpr float kScale = 1.0f / 511.5f;
  const float gx = static_cast<float>(static_cast<int>(h & 1023u)) * kScale - 1.0f;
  const float gy = static_cast<float>(static_cast<int>((h >> 10) & 1023u)) * kScale - 1.0f;
  const float gz = static_cast<float>(static_cast<int>((h >> 20) & 1023u)) * kScale - 1.0f;
  return gx * x + gy * y + gz * z;
}

float fade(float t) {
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

std::uint32_t lattice(double floored) {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(floored));
}

}  // namespace

float gradient_noise(const Eigen::Vector3d& p, std::uint32_t seed) {
  const double fx = std::floor(p.x()), fy = std::floor(p.y()), fz = std::floor(p.z());
  const auto x = static_cast<float>(p.x() - fx);
  const auto y = static_cast<float>(p.y() - fy);
  const auto z = static_cast<float>(p.z() - fz);
  constexpr std::uint32_t kX = 0x8da6b343u, kY = 0xd8163841u, kZ = 0xcb1ab31fu;
  const std::uint32_t hx = lattice(fx) * kX, hy = lattice(fy) * kY, hz = lattice(fz) * kZ;
  std::array<float, 8> value;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t dx = i & 1u, dy = (i >> 1) & 1u, dz = i >> 2;
    const std::uint32_t key = (hx + dx * kX) ^ (hy + dy * kY) ^ (hz + dz * kZ) ^ seed;
    value[i] = corner(lattice_hash(key), x - static_cast<float>(dx), y - static_cast<float>(dy),
                      z - static_cast<float>(dz));
  }
  const float u = fade(x), v = fade(y), w = fade(z);
  const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
  const float bottom = mix(mix(value[0], value[1], u), mix(value[2], value[3], u), v);
  const float top = mix(mix(value[4], value[5], u), mix(value[6], value[7], u), v);
  return mix(bottom, top, w);
}

Eigen::Vector3d turn_octave(const Eigen::Vector3d& p) {
  // Two turns with the sides of 3-4-5 and 5-12-13 triangles: exact rotations without sin and cos.
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
