// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/displace.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace axial::refine {
namespace {

constexpr float kLongestStep = 1.0f / 3;  // of the edge
constexpr float kLeastTurn = 0.5f;        // cosine
constexpr int kShortenings = 6;
constexpr int kFoldRounds = 3;

void move_to(Mesh& mesh, std::span<const Eigen::Vector3f> from, const Shape& shape,
             std::span<const float> steps) {
  parallel_for(
      from.size(), [&](std::size_t v) { mesh.vertices[v] = from[v] + steps[v] * shape.normals[v]; },
      kPointGrain);
}

// Halves the steps of vertices at faces that turned. Returns whether there are any.
bool shorten(const Mesh& mesh, const Topology& topology,
             std::span<const Eigen::Vector3f> former_faces, std::span<float> steps, bool to_zero) {
  std::vector<std::uint8_t> turned(mesh.faces.size());
  parallel_for(
      mesh.faces.size(),
      [&](std::size_t f) {
        const Eigen::Vector3f now = face_vector(mesh, mesh.faces[f]);
        const float limit = kLeastTurn * now.norm() * former_faces[f].norm();
        turned[f] = !(now.dot(former_faces[f]) >= limit);
      },
      kPointGrain);
  parallel_for(
      steps.size(),
      [&](std::size_t v) {
        for (const std::uint32_t f : topology.faces.of(v))
          if (turned[f]) {
            steps[v] = to_zero ? 0 : 0.5f * steps[v];
            return;
          }
      },
      kPointGrain);
  return std::find(turned.begin(), turned.end(), 1) != turned.end();
}

}  // namespace

void displace(Mesh& mesh, const Topology& topology, const Shape& shape,
              std::span<const float> displacement) {
  const std::vector<Eigen::Vector3f> from = mesh.vertices;
  std::vector<Eigen::Vector3f> former(mesh.faces.size());
  for (std::size_t f = 0; f < former.size(); ++f) former[f] = face_vector(mesh, mesh.faces[f]);
  std::vector<float> steps(displacement.begin(), displacement.end());
  for (std::size_t v = 0; v < steps.size(); ++v) {
    const float longest = kLongestStep * shape.edge[v];
    steps[v] = std::isfinite(steps[v]) ? std::clamp(steps[v], -longest, longest) : 0;
  }
  move_to(mesh, from, shape, steps);
  for (int k = 0; k < kShortenings; ++k) {
    if (!shorten(mesh, topology, former, steps, k + 1 == kShortenings)) return;
    move_to(mesh, from, shape, steps);
  }
}

void flatten_folds(Mesh& mesh, const Topology& topology) {
  const std::size_t count = mesh.vertices.size();
  for (int round = 0; round < kFoldRounds; ++round) {
    const Shape shape = shape_of(mesh, topology);
    std::vector<std::uint8_t> folded(mesh.faces.size());
    parallel_for(
        mesh.faces.size(),
        [&](std::size_t f) {
          const Eigen::Vector3f normal = face_vector(mesh, mesh.faces[f]);
          Eigen::Vector3f around = Eigen::Vector3f::Zero();
          for (const std::uint32_t v : mesh.faces[f]) around += shape.normals[v];
          folded[f] = normal.dot(around) < 0;
        },
        kPointGrain);
    const std::vector<Eigen::Vector3f> from = mesh.vertices;
    parallel_for(
        count,
        [&](std::size_t v) {
          const auto neighbours = topology.neighbours.of(v);
          const bool moves = std::ranges::any_of(topology.faces.of(v),
                                                 [&](std::uint32_t f) { return folded[f] != 0; });
          if (!moves || topology.border[v] || neighbours.empty()) return;
          Eigen::Vector3f sum = Eigen::Vector3f::Zero();
          for (const std::uint32_t n : neighbours) sum += from[n];
          mesh.vertices[v] = sum / static_cast<float>(neighbours.size());
        },
        kPointGrain);
  }
}

}  // namespace axial::refine
