// SPDX-License-Identifier: GPL-3.0-or-later
// The linear system of one Gauss-Newton step: the displacement of every vertex along its normal.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "refine/data_term.h"
#include "refine/topology.h"

namespace axial::refine {

// The bending of the surface at vertex v is b = n_v . (mean of the neighbours - vertex), which is
// the mean curvature times half of the squared distance e^2 of the neighbours. b^2 is counted with
// the weight smoothness * area / e^4, so that the sum approximates an integral of the squared
// curvature. At edges of the surface, where |b| / e is large, the weight is smaller, as by Cauchy's
// loss. Vertices on borders have no bending, and neither have vertices without any equation in
// their neighbourhood.
class System {
 public:
  // The arguments except `equations` must outlive the system.
  System(const Mesh& mesh, const Topology& topology, const Shape& shape,
         std::span<const FaceEquations> equations, double smoothness);

  // The sum of w g^2 of every vertex; zero for a vertex that is not measured.
  std::vector<double> information() const { return diagonal_; }

  // Adds weight * (displacement + offset)^2 to the sum that is minimised, and counts the slopes of
  // displacement + offset. Call it at most once.
  void add_anchor(std::span<const double> weight, std::span<const float> offset);

  // The displacement of every vertex [mesh units], by conjugate gradients with the diagonal as
  // preconditioner. Sums are added in an order that does not depend on the number of threads.
  std::vector<float> solve() const;

 private:
  using Vector = std::vector<double>;

  std::size_t first(std::size_t v) const { return topology_.neighbours.begin[v]; }
  std::size_t last(std::size_t v) const { return topology_.neighbours.begin[v + 1]; }
  double degree(std::size_t v) const { return static_cast<double>(last(v) - first(v)); }
  std::size_t edge_to(std::size_t v, std::uint32_t neighbour) const;
  double bending_of_mesh(std::size_t v) const;
  double bend(std::size_t v, const Vector& t) const;
  double bend_transposed(std::size_t v, const Vector& bending) const;
  void gather(std::size_t v, std::span<const FaceEquations> equations);
  double slope_weight(std::size_t v, std::uint32_t neighbour) const;
  void add_slopes(std::size_t v);
  void weigh_bending(std::size_t v, double smoothness);
  void add_bending_of_mesh();
  Vector times(const Vector& t) const;
  Vector preconditioner() const;

  const Mesh& mesh_;
  const Topology& topology_;
  const Shape& shape_;
  Vector diagonal_, right_, bending_weight_, anchor_;
  Vector stiffness_;                          // sum of the slope weights of every vertex
  std::vector<float> off_diagonal_, cosine_;  // of every neighbour of every vertex
};

}  // namespace axial::refine
