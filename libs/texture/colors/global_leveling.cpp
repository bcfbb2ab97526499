// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/colors/global_leveling.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/Sparse>

#include "base/parallel.h"

namespace axial::texture {
namespace {

using Matrix = Eigen::SparseMatrix<float, Eigen::RowMajor, int>;

// The normal equations: the lower triangle of the matrix, and a right side for each channel.
class NormalEquations {
 public:
  NormalEquations(std::size_t nodes, std::size_t entries, double smallness)
      : right_(Eigen::MatrixXf::Zero(static_cast<Eigen::Index>(nodes), 3)),
        diagonal_(nodes, static_cast<float>(smallness)) {
    entries_.reserve(entries + nodes);
  }

  // Adds weight * (g[i] - g[j] - difference)^2.
  void add(std::uint32_t i, std::uint32_t j, float weight, const Eigen::Vector3f& difference) {
    diagonal_[i] += weight;
    diagonal_[j] += weight;
    entries_.emplace_back(static_cast<int>(std::max(i, j)), static_cast<int>(std::min(i, j)),
                          -weight);
    right_.row(i) += weight * difference.transpose();
    right_.row(j) -= weight * difference.transpose();
  }

  Eigen::MatrixXf solve() {
    for (std::size_t i = 0; i < diagonal_.size(); ++i)
      entries_.emplace_back(static_cast<int>(i), static_cast<int>(i), diagonal_[i]);
    Matrix matrix(right_.rows(), right_.rows());
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    std::vector<Eigen::Triplet<float>>().swap(entries_);
    Eigen::MatrixXf result(right_.rows(), 3);
    parallel_for(3, [&](std::size_t channel) {
      Eigen::ConjugateGradient<Matrix, Eigen::Lower> solver(matrix);
      solver.setMaxIterations(500);
      solver.setTolerance(1e-3f);
      const auto c = static_cast<Eigen::Index>(channel);
      result.col(c) = solver.solve(right_.col(c));
    });
    return result;
  }

 private:
  std::vector<Eigen::Triplet<float>> entries_;
  Eigen::MatrixXf right_;
  std::vector<float> diagonal_;
};

// The means of the differences near the first and near the second vertex.
std::array<Eigen::Vector3f, 2> at_ends(std::span<const Eigen::Vector3f> differences) {
  std::array<Eigen::Vector3f, 2> sums{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
  const auto n = static_cast<float>(differences.size());
  for (std::size_t k = 0; k < differences.size(); ++k) {
    const float t = (static_cast<float>(k) + 0.5f) / n;
    sums[0] += (1 - t) * differences[k];
    sums[1] += t * differences[k];
  }
  return {sums[0] * (2 / n), sums[1] * (2 / n)};  // the sum of the weights is n / 2
}

}  // namespace

std::uint64_t bytes_to_level_globally(std::uint64_t faces, std::uint64_t seams,
                                      std::uint64_t nodes) {
  const std::uint64_t entries = 3 * faces + 2 * seams + nodes;
  // The list of entries, and twice the matrix, which is made by way of its transpose. Of each node
  // the right sides, the diagonal, the beginnings of rows and columns, and three solutions, each
  // with five vectors of the solver.
  return entries * (sizeof(Eigen::Triplet<float>) + 2 * (sizeof(float) + sizeof(int))) +
         nodes * (12 + 4 + 4 * 4 + 3 * 5 * 4 + 2 * 12);
}

std::vector<Eigen::Vector3f> level_globally(const Mesh& mesh, const Charts& charts,
                                            std::span<const Seam> seams, const SeamColors& colors,
                                            const GlobalLevelingOptions& options) {
  NormalEquations equations(charts.nodes.size(), 3 * mesh.faces.size() + 2 * seams.size(),
                            options.smallness);
  for (std::size_t s = 0; s < seams.size(); ++s) {
    const auto ends = at_ends(colors.of(s));
    for (std::size_t e = 0; e < 2; ++e) equations.add(seams[s].a[e], seams[s].b[e], 1, ends[e]);
  }
  // An edge inside a chart belongs to two faces, each of which adds half of its term.
  const auto half = static_cast<float>(0.5 * options.smoothness);
  for (const std::uint32_t f : charts.faces.items)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = charts.corners[f][k], j = charts.corners[f][(k + 1) % 3];
      if (i != j) equations.add(i, j, half, Eigen::Vector3f::Zero());
    }
  const Eigen::MatrixXf solution = equations.solve();
  std::vector<Eigen::Vector3f> result(charts.nodes.size());
  for (std::size_t n = 0; n < result.size(); ++n)
    result[n] = solution.row(static_cast<Eigen::Index>(n)).transpose();
  return result;
}

}  // namespace axial::texture
