// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/sampling.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/hash.h"
#include "geometry/faces.h"

namespace axial::geometry {
namespace {

// The k-th random number in [0, 1) of item i.
double random_unit(std::uint64_t seed, std::size_t i, unsigned k) {
  const std::uint64_t bits = scramble(scramble(scramble(seed) ^ i) + k);
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

std::vector<double> cumulative_area(const Mesh& mesh) {
  std::vector<double> sums(mesh.faces.size());
  double sum = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    for (const std::uint32_t corner : mesh.faces[i])
      if (corner >= mesh.vertices.size())
        fail("face {} of the mesh refers to vertex {}, but there are {}", i, corner,
             mesh.vertices.size());
    sum += area_vector(mesh, i).norm() / 2;
    sums[i] = sum;
  }
  if (!(sum > 0) || !std::isfinite(sum)) fail("the mesh has no area to sample");
  return sums;
}

}  // namespace

std::vector<Eigen::Vector3f> sample_surface(const Mesh& mesh, std::size_t count, std::uint64_t seed,
                                            std::vector<std::uint32_t>* faces) {
  const std::vector<double> sums = cumulative_area(mesh);
  std::vector<Eigen::Vector3f> samples(count);
  if (faces) faces->resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = (static_cast<double>(i) + random_unit(seed, i, 0)) /
                      static_cast<double>(count) * sums.back();
    const auto found = std::upper_bound(sums.begin(), sums.end(), at);
    const std::size_t face =
        std::min(static_cast<std::size_t>(found - sums.begin()), sums.size() - 1);
    if (faces) (*faces)[i] = static_cast<std::uint32_t>(face);
    const auto [a, b, c] = corners_of(mesh, face);
    const double root = std::sqrt(random_unit(seed, i, 1));
    const double v = random_unit(seed, i, 2);
    samples[i] = ((1 - root) * a + root * (1 - v) * b + root * v * c).cast<float>();
  }
  return samples;
}

std::vector<Eigen::Vector3f> subsample(std::span<const Eigen::Vector3f> points, std::size_t count,
                                       std::uint64_t seed) {
  if (points.size() <= count) return {points.begin(), points.end()};
  std::vector<Eigen::Vector3f> chosen(count);
  const double run = static_cast<double>(points.size()) / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = (static_cast<double>(i) + random_unit(seed, i, 0)) * run;
    chosen[i] = points[std::min(static_cast<std::size_t>(at), points.size() - 1)];
  }
  return chosen;
}

}  // namespace axial::geometry
