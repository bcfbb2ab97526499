// SPDX-License-Identifier: GPL-3.0-or-later
// The linear system of one Gauss-Newton step: the displacement of every vertex along its normal.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "refine/data_term.h"
#include "refine/topology.h"

namespace axial::refine {

// The normal equations of the sum that refine.h explains, without the anchor term (add_anchor()).
// The symbols e, w and g are those of refine.h. A vertex is measured if its sum of w g^2 is
// positive.
//
// Smoothness: let n_v be the normal of vertex v (Shape::normals), l its Shape::edge, area its
// Shape::area, and H the mean curvature of the surface at v. The bending at v is b = n_v . (mean of
// the neighbours - vertex), about H l^2 / 2. The system contains the square of b after the step,
// with the weight smoothness * area / l^4. The sum over the vertices then approximates smoothness /
// 4 times the integral of H^2. At edges of the surface, where |b| / l is large, the weight is
// smaller, as in Cauchy's loss. The weight is zero on borders, and where neither the vertex nor a
// neighbour is measured.
//
// Slopes: let the slope of an edge be the difference between the displacements of its two ends,
// divided by the length of the edge. The system contains the square of the slope of each edge with
// a measured end, with the weight 9 / 0.2^2. 0.2 is the expected slope. The factor 9 is the factor
// by which the residuals of pixels exceed independent residuals in variance, as in sigma of
// anchor.h.
class System {
 public:
  // `equations`: one per face of the mesh. `smoothness`: Options::smoothness. `mesh`, `topology`
  // and `shape` must outlive the system.
  System(const Mesh& mesh, const Topology& topology, const Shape& shape,
         std::span<const FaceEquations> equations, double smoothness);

  // The sum of w g^2 for every vertex. Zero for a vertex that is not measured.
  std::vector<double> information() const { return diagonal_; }

  // Adds weight * (displacement + offset)^2 for every vertex to the sum that is minimised. `weight`
  // and `offset` [mesh units]: of the anchor term (Anchor), one entry per vertex. The slopes are
  // then those of displacement + offset, not those of the displacement alone. Call it at most once.
  void add_anchor(std::span<const double> weight, std::span<const float> offset);

  // The displacement of every vertex along its normal [mesh units]. The method is conjugate
  // gradients with the diagonal as preconditioner, for at most 100 iterations. The result does not
  // depend on the number of threads.
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
