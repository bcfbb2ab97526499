// SPDX-License-Identifier: GPL-3.0-or-later
#include <ceres/crs_matrix.h>
#include <fmt/format.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "pose/adjust.h"
#include "pose/adjust_problem.h"
#include "pose/sparse_cholesky.h"
#include "scene/decompositions.h"

namespace axial::pose {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

std::size_t unknowns_of(const Bundle& bundle, const AdjustOptions& options) {
  const std::size_t points = options.points_known ? 0 : bundle.points.size();
  std::size_t free = 0;
  for (const BundleCamera& camera : bundle.cameras)
    free += static_cast<std::size_t>(std::ranges::count(options.unknowns(camera).free, true));
  // The poses of images without observations are not adjusted.
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  auto images = counts.size() -
                static_cast<std::size_t>(std::count(counts.begin(), counts.end(), std::size_t{0}));
  const bool held = options.points_known || options.positions.size() >= 3;
  if (!held) --images;
  if (options.poses_known) images = 0;
  return kPoseNumbers * images + free + 3 * points;
}

Sparse jacobian(ceres::Problem& problem, const std::vector<double*>& blocks) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = blocks;
  options.num_threads = 1;
  ceres::CRSMatrix crs;
  problem.Evaluate(options, nullptr, nullptr, nullptr, &crs);
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(crs.num_rows, crs.num_cols,
                                static_cast<Eigen::Index>(crs.values.size()), crs.rows.data(),
                                crs.cols.data(), crs.values.data());
}

// The inverse of a block-diagonal matrix with one 3 x 3 block for each point.
Sparse inverse_of_blocks(const Sparse& blocks) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int start = 0; start < blocks.cols(); start += 3) {
    const Eigen::Matrix3d block = blocks.block(start, start, 3, 3);
    // A point without observations, or at infinity, gives no information about the poses.
    const SymmetricEigen3 eigen(block);
    if (!(eigen.eigenvalues()(2) > 0)) continue;
    const Eigen::Vector3d values = eigen.eigenvalues().cwiseMax(1e-12 * eigen.eigenvalues()(2));
    const Eigen::Matrix3d inverse = eigen.eigenvectors() * values.cwiseInverse().asDiagonal() *
                                    eigen.eigenvectors().transpose();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) entries.emplace_back(start + i, start + j, inverse(i, j));
  }
  Sparse result(blocks.rows(), blocks.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

// The normal matrix of the camera parameters, with the points eliminated (Schur complement). It is
// sparse: two images share entries only if they observe a common point.
Sparse reduced_normal_matrix(const Sparse& jacobian, Eigen::Index camera_columns) {
  const Sparse cameras = jacobian.leftCols(camera_columns);
  const Sparse points = jacobian.rightCols(jacobian.cols() - camera_columns);
  const Sparse across = cameras.transpose() * points;
  const Sparse own = points.transpose() * points;
  const Sparse eliminated = across * inverse_of_blocks(own) * Sparse(across.transpose());
  return Sparse(cameras.transpose() * cameras) - eliminated;
}

// Of one core, for the factorization of surveys with 2,400 to 10,000 images.
constexpr double kOperationsPerSecond = 1.2e10;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Covariance of a vector with the given normal matrix. The matrix is scaled first, since metres,
// radians and indices differ by orders of magnitude. `start`: see SparseCholesky.
class Covariance {
 public:
  Covariance(const Sparse& normal, const std::function<void(double operations)>& start)
      : scale_(normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse()),
        factor_(damped(scale_.asDiagonal() * normal * scale_.asDiagonal()), start) {}

  // The variance along `direction`. Infinite along directions that nothing but the damping
  // determines.
  double variance(const Eigen::VectorXd& direction) const {
    const Eigen::VectorXd scaled = scale_.asDiagonal() * direction;
    if (!factor_.is_positive_definite() || scaled.isZero(0)) return kInfinite;
    const double variance = factor_.inverse_form(scaled);
    const bool determined = variance < 1e-3 / kDamping * scaled.squaredNorm();
    return determined ? variance : kInfinite;
  }

 private:
  static constexpr double kDamping = 1e-12;

  static Sparse damped(const Sparse& matrix) {
    Sparse damping(matrix.rows(), matrix.cols());
    damping.setIdentity();
    return matrix + kDamping * damping;
  }

  Eigen::VectorXd scale_;
  SparseCholesky factor_;
};

// The normal equations at the solution, and the columns of each parameter block.
class Normal {
 public:
  Normal(const Bundle& bundle, const AdjustOptions& options,
         const std::function<void(const std::string&)>& progress)
      : problem_(bundle, options), bundle_(bundle), options_(options) {
    std::vector<double*> blocks = problem_.camera_blocks();
    for (const double* block : blocks) {
      columns_[block] = camera_columns_;
      camera_columns_ += problem_.problem().ParameterBlockTangentSize(block);
    }
    for (double* block : problem_.point_blocks()) blocks.push_back(block);
    if (camera_columns_ == 0) return;
    if (progress) progress("standard deviations: normal equations");
    const Sparse normal =
        reduced_normal_matrix(jacobian(problem_.problem(), blocks), camera_columns_);
    covariance_.emplace(normal, [&](double operations) {
      if (progress)
        progress(fmt::format("standard deviations: factorization of {} equations, about {:.0f} s",
                             camera_columns_, std::ceil(operations / kOperationsPerSecond)));
    });
  }

  HousingChange<double> sigmas_of_camera(std::size_t camera) {
    HousingChange<double> sigmas = HousingChange<double>::Zero();
    const auto found = columns_.find(problem_.change_block(camera));
    const bool observed = found != columns_.end();
    Eigen::Index column = observed ? found->second : 0;
    const auto& free = options_.unknowns(bundle_.cameras[camera]).free;
    for (int k = 0; k < kHousingNumbers; ++k) {
      if (!free[static_cast<std::size_t>(k)]) continue;
      sigmas(k) = kInfinite;
      if (observed)
        sigmas(k) =
            std::sqrt(covariance_->variance(Eigen::VectorXd::Unit(camera_columns_, column++)));
    }
    return sigmas;
  }

  // The relative standard deviation of the distance between the first image and the image farthest
  // from it.
  double sigma_of_scale() {
    const std::size_t from = problem_.anchor(), to = farthest_from(from);
    if (from == to) return kInfinite;
    const Eigen::Vector3d baseline =
        bundle_.images[to].pose.centre - bundle_.images[from].pose.centre;
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(camera_columns_);
    add_centre(to, baseline.normalized(), direction);
    add_centre(from, -baseline.normalized(), direction);
    return std::sqrt(covariance_->variance(direction)) / baseline.norm();
  }

 private:
  std::size_t farthest_from(std::size_t from) const {
    std::size_t farthest = from;
    double largest = 0;
    for (std::size_t i = 0; i < bundle_.images.size(); ++i) {
      const double distance =
          (bundle_.images[i].pose.centre - bundle_.images[from].pose.centre).norm();
      if (problem_.is_observed(i) && distance > largest) largest = distance, farthest = i;
    }
    return farthest;
  }

  void add_centre(std::size_t image, const Eigen::Vector3d& along, Eigen::VectorXd& direction) {
    const auto found = columns_.find(problem_.image_block(image));
    if (found != columns_.end()) direction.segment<3>(found->second + 3) += along;
  }

  AdjustProblem problem_;
  const Bundle& bundle_;
  const AdjustOptions& options_;
  std::map<const double*, Eigen::Index> columns_;
  Eigen::Index camera_columns_ = 0;
  std::optional<Covariance> covariance_;
};

}  // namespace

double observed_pixel_sigma(const Bundle& bundle, const AdjustOptions& options) {
  const std::vector<double> errors = reprojection_errors(bundle);
  const double residuals = 2.0 * static_cast<double>(errors.size());
  const double free = std::max(1.0, residuals - static_cast<double>(unknowns_of(bundle, options)));
  constexpr double kLeast = 1e-9;  // [px], size of rounding errors
  return std::max(kLeast, root_mean_square(errors) * std::sqrt(residuals / (2 * free)));
}

Uncertainty uncertainty(const Bundle& bundle, const AdjustOptions& options,
                        const std::function<void(const std::string&)>& progress) {
  Uncertainty result;
  result.pixel_sigma = observed_pixel_sigma(bundle, options);
  AdjustOptions weighed = options;
  weighed.pixel_sigma = result.pixel_sigma;
  Normal normal(bundle, weighed, progress);
  for (std::size_t camera = 0; camera < bundle.cameras.size(); ++camera)
    result.camera_sigmas.push_back(normal.sigmas_of_camera(camera));
  if (!options.poses_known) result.scale_sigma = normal.sigma_of_scale();
  return result;
}

}  // namespace axial::pose
