// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/system.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace axial::refine {
namespace {

constexpr double kSharp = 0.1;  // |b| / e at which the weight of bending is one half
// The expected difference of the displacements of two neighbours, per distance; and the variance
// of residuals that depend on each other (see anchor.cpp), relative to that of independent ones.
constexpr double kSlope = 0.2, kDependentResiduals = 9;
// Added to the diagonal, relative to it: an eigenvalue is never zero.
constexpr double kDamping = 1e-3;
constexpr unsigned kMaxIterations = 100;
constexpr double kTolerance = 1e-3;  // of the residual, relative to that of no displacement

template <class Body>
void for_each_item(std::size_t count, const Body& body) {
  parallel_for(count, body, kPointGrain);
}

// The scalar product, in portions of kPointGrain.
double dot(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> sums((a.size() + kPointGrain - 1) / kPointGrain);
  parallel_for(sums.size(), [&](std::size_t portion) {
    const std::size_t end = std::min(a.size(), (portion + 1) * kPointGrain);
    for (std::size_t i = portion * kPointGrain; i < end; ++i) sums[portion] += a[i] * b[i];
  });
  double total = 0;
  for (const double sum : sums) total += sum;
  return total;
}

}  // namespace

System::System(const Mesh& mesh, const Topology& topology, const Shape& shape,
               std::span<const FaceEquations> equations, double smoothness)
    : mesh_(mesh),
      topology_(topology),
      shape_(shape),
      diagonal_(mesh.vertices.size()),
      right_(mesh.vertices.size()),
      bending_weight_(mesh.vertices.size()),
      anchor_(mesh.vertices.size()),
      stiffness_(mesh.vertices.size()),
      off_diagonal_(topology.neighbours.items.size()),
      cosine_(topology.neighbours.items.size()) {
  for_each_item(right_.size(), [&](std::size_t v) { gather(v, equations); });
  for_each_item(right_.size(), [&](std::size_t v) { add_slopes(v); });
  for_each_item(right_.size(), [&](std::size_t v) { weigh_bending(v, smoothness); });
  add_bending_of_mesh();
}

std::size_t System::edge_to(std::size_t v, std::uint32_t neighbour) const {
  const auto of = topology_.neighbours.of(v);
  return first(v) +
         static_cast<std::size_t>(std::lower_bound(of.begin(), of.end(), neighbour) - of.begin());
}

void System::gather(std::size_t v, std::span<const FaceEquations> equations) {
  constexpr std::size_t kEntry[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  for (std::size_t e = first(v); e < last(v); ++e)
    cosine_[e] = shape_.normals[v].dot(shape_.normals[topology_.neighbours.items[e]]);
  for (const std::uint32_t f : topology_.faces.of(v)) {
    const auto& face = mesh_.faces[f];
    for (std::size_t k = 0; k < 3; ++k) {
      if (face[k] != v) continue;
      right_[v] += equations[f].right[k];
      for (std::size_t j = 0; j < 3; ++j)
        if (face[j] == v)
          diagonal_[v] += equations[f].matrix[kEntry[k][j]];
        else
          off_diagonal_[edge_to(v, face[j])] += equations[f].matrix[kEntry[k][j]];
    }
  }
}

double System::slope_weight(std::size_t v, std::uint32_t neighbour) const {
  // Vertices that nearly coincide would count more than a float can hold.
  const double least = 1e-3 * static_cast<double>(std::min(shape_.edge[v], shape_.edge[neighbour]));
  const double squared =
      std::max(static_cast<double>((mesh_.vertices[neighbour] - mesh_.vertices[v]).squaredNorm()),
               least * least);
  const bool measured = diagonal_[v] > 0 || diagonal_[neighbour] > 0;
  return measured && squared > 0 ? kDependentResiduals / (kSlope * kSlope * squared) : 0;
}

void System::add_slopes(std::size_t v) {
  for (std::size_t e = first(v); e < last(v); ++e) {
    const auto weight = static_cast<float>(slope_weight(v, topology_.neighbours.items[e]));
    stiffness_[v] += static_cast<double>(weight);
    off_diagonal_[e] -= weight;
  }
}

double System::bending_of_mesh(std::size_t v) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t n : topology_.neighbours.of(v))
    sum += (mesh_.vertices[n] - mesh_.vertices[v]).cast<double>();
  return sum.dot(shape_.normals[v].cast<double>()) / degree(v);
}

void System::weigh_bending(std::size_t v, double smoothness) {
  bool measured = diagonal_[v] > 0;
  for (const std::uint32_t n : topology_.neighbours.of(v)) measured |= diagonal_[n] > 0;
  const double edge = shape_.edge[v];
  if (!measured || topology_.border[v] || !(edge > 0)) return;
  const double sharpness = bending_of_mesh(v) / edge / kSharp;
  bending_weight_[v] =
      smoothness * shape_.area[v] / (edge * edge * edge * edge) / (1 + sharpness * sharpness);
}

void System::add_bending_of_mesh() {
  Vector bending(right_.size());
  for_each_item(right_.size(), [&](std::size_t v) {
    if (bending_weight_[v] > 0) bending[v] = bending_weight_[v] * bending_of_mesh(v);
  });
  for_each_item(right_.size(), [&](std::size_t v) { right_[v] -= bend_transposed(v, bending); });
}

void System::add_anchor(std::span<const double> weight, std::span<const float> offset) {
  for_each_item(right_.size(), [&](std::size_t v) {
    anchor_[v] = weight[v];
    right_[v] -= weight[v] * offset[v];
    for (const std::uint32_t n : topology_.neighbours.of(v))
      right_[v] -= slope_weight(v, n) * (offset[v] - offset[n]);
  });
}

double System::bend(std::size_t v, const Vector& t) const {
  double sum = 0;
  for (std::size_t e = first(v); e < last(v); ++e)
    sum += cosine_[e] * t[topology_.neighbours.items[e]];
  return sum / degree(v) - t[v];
}

double System::bend_transposed(std::size_t v, const Vector& bending) const {
  double sum = -bending[v];
  for (std::size_t e = first(v); e < last(v); ++e) {
    const std::uint32_t n = topology_.neighbours.items[e];
    sum += cosine_[e] * bending[n] / degree(n);
  }
  return sum;
}

System::Vector System::times(const Vector& t) const {
  Vector bending(t.size()), result(t.size());
  for_each_item(t.size(), [&](std::size_t v) {
    if (bending_weight_[v] > 0) bending[v] = bending_weight_[v] * bend(v, t);
  });
  for_each_item(t.size(), [&](std::size_t v) {
    double sum = ((1 + kDamping) * diagonal_[v] + anchor_[v] + stiffness_[v]) * t[v];
    for (std::size_t e = first(v); e < last(v); ++e)
      sum += off_diagonal_[e] * t[topology_.neighbours.items[e]];
    result[v] = sum + bend_transposed(v, bending);
  });
  return result;
}

System::Vector System::preconditioner() const {
  Vector inverse(right_.size());
  for_each_item(inverse.size(), [&](std::size_t v) {
    double sum = (1 + kDamping) * diagonal_[v] + anchor_[v] + stiffness_[v] + bending_weight_[v];
    for (std::size_t e = first(v); e < last(v); ++e) {
      const std::uint32_t n = topology_.neighbours.items[e];
      const double share = cosine_[e] / degree(n);
      sum += bending_weight_[n] * share * share;
    }
    inverse[v] = sum > 0 ? 1 / sum : 0;
  });
  return inverse;
}

std::vector<float> System::solve() const {
  const std::size_t count = right_.size();
  const Vector inverse = preconditioner();
  Vector t(count), residual = right_, conditioned(count);
  for_each_item(count, [&](std::size_t i) { conditioned[i] = inverse[i] * residual[i]; });
  Vector direction = conditioned;
  double product = dot(residual, conditioned);
  const double enough = kTolerance * kTolerance * product;
  for (unsigned k = 0; k < kMaxIterations && product > enough; ++k) {
    const Vector image = times(direction);
    const double curvature = dot(direction, image);
    if (!(curvature > 0)) break;
    const double step = product / curvature;
    for_each_item(count, [&](std::size_t i) {
      t[i] += step * direction[i];
      residual[i] -= step * image[i];
      conditioned[i] = inverse[i] * residual[i];
    });
    const double next = dot(residual, conditioned);
    for_each_item(count, [&](std::size_t i) {
      direction[i] = conditioned[i] + next / product * direction[i];
    });
    product = next;
  }
  return {t.begin(), t.end()};
}

}  // namespace axial::refine
