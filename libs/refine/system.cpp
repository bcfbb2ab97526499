// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/system.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace axial::refine {
double env(const char* n, double d);
namespace {

using Vector = std::vector<double>;

// The sum of term(i) for i in [0, count), in portions of kPointGrain.
template <class Term>
double sum_of(std::size_t count, const Term& term) {
  std::vector<double> sums((count + kPointGrain - 1) / kPointGrain);
  parallel_for(sums.size(), [&](std::size_t portion) {
    const std::size_t end = std::min(count, (portion + 1) * kPointGrain);
    for (std::size_t i = portion * kPointGrain; i < end; ++i) sums[portion] += term(i);
  });
  double total = 0;
  for (const double sum : sums) total += sum;
  return total;
}

double dot(const Vector& a, const Vector& b) {
  return sum_of(a.size(), [&](std::size_t i) { return a[i] * b[i]; });
}

class System {
 public:
  System(const Mesh& mesh, const Topology& topology, const Shape& shape,
         std::span<const FaceEquations> equations, double smoothness, const SystemOptions& options)
      : mesh_(mesh),
        topology_(topology),
        shape_(shape),
        diagonal_(mesh.vertices.size()),
        right_(mesh.vertices.size()),
        bending_weight_(mesh.vertices.size()),
        off_diagonal_(topology.neighbours.item.size()),
        cosine_(topology.neighbours.item.size()) {
    each([&](std::size_t v) { gather(v, equations); });
    if (!options.anchor.empty())
      each([&](std::size_t v) {
        const double w = options.anchor[v];
        right_[v] -= w * options.offset[v];
        diagonal_[v] += w;
      });
    each([&](std::size_t v) { weigh(v, smoothness); });
    add_bending_of_the_mesh();
  }

  std::size_t size() const { return right_.size(); }
  const Vector& right() const { return right_; }
  bool measured(std::size_t v) const { return diagonal_[v] > 0; }

  Vector times(const Vector& t) const {
    Vector bending(size()), result(size());
    each([&](std::size_t v) { bending[v] = bending_weight_[v] * bend(v, t); });
    each([&](std::size_t v) {
      double sum = (diagonal_[v] + kDamping * diagonal_[v]) * t[v];
      for (std::size_t e = first(v); e < last(v); ++e)
        sum += off_diagonal_[e] * t[topology_.neighbours.item[e]];
      result[v] = sum + bend_transposed(v, bending);
    });
    return result;
  }

  Vector preconditioner() const {
    Vector inverse(size());
    each([&](std::size_t v) {
      double sum = diagonal_[v] * (1 + kDamping) + bending_weight_[v];
      for (std::size_t e = first(v); e < last(v); ++e) {
        const std::uint32_t n = topology_.neighbours.item[e];
        const double share = cosine_[e] / degree(n);
        sum += bending_weight_[n] * share * share;
      }
      inverse[v] = sum > 0 ? 1 / sum : 0;
    });
    return inverse;
  }

 private:
  static constexpr double kDamping = 1e-3;

  template <class Body>
  void each(const Body& body) const {
    parallel_for(mesh_.vertices.size(), body, kPointGrain);
  }
  std::size_t first(std::size_t v) const { return topology_.neighbours.begin[v]; }
  std::size_t last(std::size_t v) const { return topology_.neighbours.begin[v + 1]; }
  double degree(std::size_t v) const { return static_cast<double>(last(v) - first(v)); }

  std::size_t edge_to(std::size_t v, std::uint32_t neighbour) const {
    const auto of = topology_.neighbours.of(v);
    return first(v) +
           static_cast<std::size_t>(std::lower_bound(of.begin(), of.end(), neighbour) - of.begin());
  }

  void gather(std::size_t v, std::span<const FaceEquations> equations) {
    constexpr std::size_t kEntry[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    for (std::size_t e = first(v); e < last(v); ++e)
      cosine_[e] = shape_.normals[v].dot(shape_.normals[topology_.neighbours.item[e]]);
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

  void weigh(std::size_t v, double smoothness) {
    bool anything = diagonal_[v] > 0;
    for (const std::uint32_t n : topology_.neighbours.of(v)) anything |= diagonal_[n] > 0;
    if (!anything || topology_.border[v] || !(shape_.edge[v] > 0)) return;
    const double squared = static_cast<double>(shape_.edge[v]) * shape_.edge[v];
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (const std::uint32_t n : topology_.neighbours.of(v))
      mean += mesh_.vertices[n] - mesh_.vertices[v];
    const double bent = mean.dot(shape_.normals[v]) / degree(v) / shape_.edge[v] / robust_;
    bending_weight_[v] = 1 / (1 + bent * bent) * smoothness * shape_.area[v] / (squared * squared);
  }

  double bend(std::size_t v, const Vector& t) const {
    if (bending_weight_[v] == 0) return 0;
    double sum = 0;
    for (std::size_t e = first(v); e < last(v); ++e)
      sum += cosine_[e] * t[topology_.neighbours.item[e]];
    return sum / degree(v) - t[v];
  }

  double bend_transposed(std::size_t v, const Vector& bending) const {
    double sum = -bending[v];
    for (std::size_t e = first(v); e < last(v); ++e) {
      const std::uint32_t n = topology_.neighbours.item[e];
      if (bending[n] != 0) sum += cosine_[e] * bending[n] / degree(n);
    }
    return sum;
  }

  void add_bending_of_the_mesh() {
    Vector bending(size());
    each([&](std::size_t v) {
      if (bending_weight_[v] == 0) return;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const std::uint32_t n : topology_.neighbours.of(v))
        sum += (mesh_.vertices[n] - mesh_.vertices[v]).cast<double>();
      bending[v] = bending_weight_[v] * sum.dot(shape_.normals[v].cast<double>()) / degree(v);
    });
    each([&](std::size_t v) { right_[v] -= bend_transposed(v, bending); });
  }

  double robust_ = env("ROBUST", 1e9);
  const Mesh& mesh_;
  const Topology& topology_;
  const Shape& shape_;
  Vector diagonal_, right_, bending_weight_;
  std::vector<float> off_diagonal_, cosine_;  // of every neighbour of every vertex
};

Vector conjugate_gradients(const System& system, const SystemOptions& options) {
  const std::size_t count = system.size();
  const auto each = [&](const auto& body) { parallel_for(count, body, kPointGrain); };
  const Vector inverse = system.preconditioner();
  Vector t(count), residual = system.right(), conditioned(count), direction(count);
  each([&](std::size_t i) { conditioned[i] = inverse[i] * residual[i]; });
  direction = conditioned;
  double product = dot(residual, conditioned);
  const double enough = options.tolerance * options.tolerance * product;
  for (unsigned k = 0; k < options.max_iterations && product > enough && product > 0; ++k) {
    const Vector image = system.times(direction);
    const double step = product / dot(direction, image);
    each([&](std::size_t i) {
      t[i] += step * direction[i];
      residual[i] -= step * image[i];
      conditioned[i] = inverse[i] * residual[i];
    });
    const double next = dot(residual, conditioned);
    each([&](std::size_t i) { direction[i] = conditioned[i] + next / product * direction[i]; });
    product = next;
  }
  return t;
}

}  // namespace

Solution solve(const Mesh& mesh, const Topology& topology, const Shape& shape,
               std::span<const FaceEquations> equations, const SystemOptions& options) {
  const System system(mesh, topology, shape, equations, options.smoothness, options);
  const Vector t = conjugate_gradients(system, options);
  Solution solution;
  solution.displacement.assign(t.begin(), t.end());
  solution.measured.resize(t.size());
  for (std::size_t v = 0; v < t.size(); ++v) solution.measured[v] = system.measured(v);
  return solution;
}

}  // namespace axial::refine
