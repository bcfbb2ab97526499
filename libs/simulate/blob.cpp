// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/blob.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "simulate/noise.h"

namespace axial::simulate {
namespace {

// Rounded lumps with sharp valleys between them, and smaller lumps on top.
double lumps(const Eigen::Vector3d& p, std::uint32_t seed) {
  const float broad = fractal_noise(1.1 * p, seed, 2, 0.5f);
  const float cracks = std::abs(gradient_noise(turn_octave(2.6 * p), seed + 5u));
  const float rough = fractal_noise(6.0 * p, seed + 9u, 4, 0.55f);
  return 1.6 * broad + 0.7 * (cracks - 0.2) + 0.30 * rough;
}

// An arch reaches from below the ground on one side to below the ground on the other side: the
// angles of its ends [rad].
constexpr double kArchFrom = -0.35, kArchTo = std::numbers::pi + 0.35;

// The middle of the tube at the angle `t`, from the centre of the arch.
Eigen::Vector3d spine_of(const Arch& arch, double t) {
  const Eigen::Vector3d along(arch.along.x(), arch.along.y(), 0), up(0, 0, 1);
  return arch.span_radius * (std::cos(t) * along + arch.rise * std::sin(t) * up);
}

// The radius of the tube at the angle `t` in the unit direction `around`.
double radius_of(const Arch& arch, double t, const Eigen::Vector3d& around) {
  const Eigen::Vector3d key = spine_of(arch, t) / (2 * arch.tube_radius) + 0.7 * around;
  const double swell = 1 + arch.roughness * lumps(key, arch.seed);
  return arch.tube_radius * std::max(0.35, swell);
}

}  // namespace

double Blob::relief(const Eigen::Vector3d& unit_direction) const {
  const Eigen::Vector3d shift(0.37 * (seed % 97u), 0.71 * (seed % 89u), 0.53 * (seed % 83u));
  return std::max(-0.7, roughness * lumps(unit_direction + shift, seed));
}

bool Blob::contains(const Eigen::Vector3d& p, double margin) const {
  const Eigen::Vector3d q = (turn.transpose() * (p - centre)).cwiseQuotient(radii);
  const double r = q.norm();
  if (r < 1e-9) return true;
  if (r > kReach) return false;
  return r < 1 + relief(q / r) - margin / radii.minCoeff();
}

TriangleMesh blob_mesh(const Blob& blob, double cell) {
  // An icosahedron's edge is 1.05 radii long, and each level halves it.
  const double halvings = std::log2(1.05 * blob.radii.maxCoeff() / cell);
  TriangleMesh mesh = unit_sphere(std::clamp(static_cast<int>(std::lround(halvings)), 2, 8));
  parallel_for(
      mesh.vertices.size(),
      [&](std::size_t i) {
        const Eigen::Vector3d direction = mesh.vertices[i].cast<double>().normalized();
        const Eigen::Vector3d local = (1 + blob.relief(direction)) * direction;
        mesh.vertices[i] = (blob.centre + blob.turn * local.cwiseProduct(blob.radii)).cast<float>();
      },
      1024);
  return mesh;
}

bool Arch::contains(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d side(along.x(), along.y(), 0), across(-along.y(), along.x(), 0);
  const Eigen::Vector3d q = p - centre;
  const double a = side.dot(q), z = q.z(), bulge = span_radius * (rise - 1);
  // The cross section through `p` is the one in whose plane `p` lies.
  double t = std::atan2(z, a);
  if (t < -std::numbers::pi / 2) t += 2 * std::numbers::pi;
  for (int i = 0; i < 8; ++i) {
    const double sine = std::sin(t), cosine = std::cos(t);
    const double off = z * cosine - a * sine - bulge * sine * cosine;
    const double slope = -z * sine - a * cosine - bulge * (cosine * cosine - sine * sine);
    if (!(slope < 0)) return false;  // nearer to the centre than to the tube
    t -= off / slope;
  }
  if (!(t > kArchFrom && t < kArchTo)) return false;
  const Eigen::Vector3d from_spine = q - spine_of(*this, t);
  const double r = from_spine.norm();
  return r < tube_radius * 1e-6 || r < radius_of(*this, t, from_spine / r);
}

TriangleMesh arch_mesh(const Arch& arch, double cell) {
  const double pi = std::numbers::pi, from = kArchFrom, to = kArchTo;
  const auto rows = static_cast<std::size_t>(std::ceil((to - from) * arch.span_radius *
                                                       std::max(1.0, arch.rise) / cell)) +
                    2;
  const auto columns = static_cast<std::size_t>(std::ceil(2.4 * pi * arch.tube_radius / cell)) + 3;
  const Eigen::Vector3d along(arch.along.x(), arch.along.y(), 0);
  const Eigen::Vector3d across(-arch.along.y(), arch.along.x(), 0);
  return grid_mesh(rows, columns, true, [&](std::size_t r, std::size_t c) -> Eigen::Vector3d {
    const double t = from + (to - from) * static_cast<double>(r) / static_cast<double>(rows - 1);
    const double s = 2 * pi * static_cast<double>(c) / static_cast<double>(columns);
    const Eigen::Vector3d up(0, 0, 1);
    const Eigen::Vector3d outward = std::cos(t) * along + std::sin(t) * up;
    const Eigen::Vector3d around = std::cos(s) * outward - std::sin(s) * across;
    return arch.centre + spine_of(arch, t) + radius_of(arch, t, around) * around;
  });
}

}  // namespace axial::simulate
