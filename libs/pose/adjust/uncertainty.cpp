// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/uncertainty.h"

#include <ceres/crs_matrix.h>
#include <fmt/format.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "pose/adjust/adjust_problem.h"
#include "pose/adjust/shape_sigma.h"
#include "pose/adjust/sparse_cholesky.h"
#include "scene/decompositions.h"
#include "scene/sparse_places.h"

namespace axial::pose {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

std::size_t unknowns_of(const Bundle& bundle, const AdjustOptions& options) {
  const std::size_t points = options.points_known
                                 ? 0
                                 : static_cast<std::size_t>(std::ranges::count(
                                       bundle.points, false, &BundlePoint::is_target));
  std::size_t free = 0;
  for (const BundleCamera& camera : bundle.cameras)
    if (!camera.same_as)
      free += static_cast<std::size_t>(std::ranges::count(options.unknowns(camera).free, true));
  // The poses of images without observations are not adjusted.
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  auto images = counts.size() -
                static_cast<std::size_t>(std::count(counts.begin(), counts.end(), std::size_t{0}));
  const bool held =
      options.points_known || options.positions.size() >= 3 || !options.places.empty();
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

  // The covariance times `direction`. Precondition: variance(direction) is finite.
  Eigen::VectorXd times(const Eigen::VectorXd& direction) const {
    return scale_.asDiagonal() * factor_.solve(scale_.asDiagonal() * direction);
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

Unknowns& unknowns_for(const BundleCamera& camera, AdjustOptions& options) {
  const auto& port = camera.measured.port;
  if (!port) return *options.of_air;
  return std::holds_alternative<refractive::DomePort<double>>(*port) ? *options.of_domes : options;
}

// The options with all numbers free whose errors count: the free numbers, and without their
// measurement the numbers that were measured and stay fixed.
AdjustOptions with_fixed_numbers(const Bundle& bundle, const AdjustOptions& options) {
  AdjustOptions all = options;
  if (options.poses_known) return all;  // the scale is exact
  if (!all.of_domes) all.of_domes = static_cast<const Unknowns&>(options);
  if (!all.of_air) all.of_air = static_cast<const Unknowns&>(options);
  for (const BundleCamera& camera : bundle.cameras) {
    Unknowns& unknowns = unknowns_for(camera, all);
    for (int k = camera.measured.port ? 0 : kFocalNumber; k < kHousingNumbers; ++k) {
      const auto number = static_cast<std::size_t>(k);
      if (unknowns.free[number] || !(options.sigma_before(camera, k) > 0)) continue;
      unknowns.free[number] = true;
      unknowns.prior_sigma[number] = kInfinite;
    }
  }
  return all;
}

// The normal equations at the solution. Their unknowns are the poses, the free numbers and the
// points. The numbers that were measured and stay fixed have columns of their own.
class Normal {
 public:
  Normal(const Bundle& bundle, const AdjustOptions& options, const Context& context)
      : all_(with_fixed_numbers(bundle, options)),
        problem_(bundle, all_),
        bundle_(bundle),
        options_(options) {
    std::vector<double*> blocks = problem_.camera_blocks();
    Eigen::Index columns = 0;
    for (const double* block : blocks) {
      columns_[block] = columns;
      columns += problem_.problem().ParameterBlockTangentSize(block);
    }
    for (double* block : problem_.point_blocks()) blocks.push_back(block);
    select_columns(columns);
    if (unknowns_ == 0) return;
    if (is_long()) context.info("standard deviations: normal equations");
    Sparse normal = reduced_normal_matrix(jacobian(problem_.problem(), blocks), columns);
    if (!fixed_.empty()) {
      const Sparse chosen = selection(columns);
      by_fixed_ = chosen.transpose() * Sparse(normal * fixed_columns(columns));
      normal = chosen.transpose() * Sparse(normal * chosen);
    }
    covariance_.emplace(normal, [&](double operations) {
      if (is_long())
        context.info("standard deviations: factorization of {} equations, about {:.0f} s",
                     unknowns_, std::ceil(operations / kOperationsPerSecond));
    });
  }

  HousingChange<double> sigmas_of_camera(std::size_t camera) {
    HousingChange<double> sigmas = HousingChange<double>::Zero();
    const auto& free = options_.unknowns(bundle_.cameras[camera]).free;
    for (int k = 0; k < kHousingNumbers; ++k) {
      if (!free[static_cast<std::size_t>(k)]) continue;
      const auto column = column_of(camera, k);
      sigmas(k) = kInfinite;
      if (column)
        sigmas(k) = std::sqrt(
            covariance_->variance(Eigen::VectorXd::Unit(unknowns_, unknown_of_column_[*column])));
    }
    return sigmas;
  }

  RigSigma sigmas_in_rig(std::size_t rig, std::size_t camera) {
    RigSigma sigmas;
    double* const block = problem_.rig_block(rig, camera);
    if (bundle_.rigs[rig].cameras[camera].known == RigCamera::Known::fixed) return sigmas;
    const auto found = columns_.find(block);
    for (int k = 0; k < kPoseNumbers; ++k) {
      double& sigma = k < 3 ? sigmas.rotation(k) : sigmas.translation(k - 3);
      sigma = kInfinite;
      if (found == columns_.end()) continue;
      const Eigen::Index unknown = unknown_of_column_[static_cast<std::size_t>(found->second + k)];
      sigma = std::sqrt(covariance_->variance(Eigen::VectorXd::Unit(unknowns_, unknown)));
    }
    return sigmas;
  }

  NumbersCovariance covariance_of_numbers() {
    NumbersCovariance result;
    std::vector<Eigen::VectorXd> rows;
    std::vector<Eigen::Index> unknowns;
    for (std::size_t camera = 0; camera < bundle_.cameras.size(); ++camera) {
      const HousingChange<double> sigmas = sigmas_of_camera(camera);
      for (int k = 0; !bundle_.cameras[camera].same_as && k < kHousingNumbers; ++k) {
        if (!(sigmas(k) > 0 && std::isfinite(sigmas(k)))) continue;
        unknowns.push_back(unknown_of_column_[*column_of(camera, k)]);
        rows.push_back(covariance_->times(Eigen::VectorXd::Unit(unknowns_, unknowns.back())));
        result.numbers.push_back({camera, k});
      }
    }
    const auto count = static_cast<Eigen::Index>(rows.size());
    result.covariance.resize(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j)
        result.covariance(i, j) =
            rows[static_cast<std::size_t>(i)](unknowns[static_cast<std::size_t>(j)]);
    return result;
  }

  // The relative standard deviation of the distance between the first image and the image farthest
  // from it.
  double sigma_of_scale() {
    const std::size_t from = problem_.anchor(), to = farthest_from(from);
    if (from == to) return kInfinite;
    const Eigen::Vector3d baseline =
        bundle_.images[to].pose.centre - bundle_.images[from].pose.centre;
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(unknowns_);
    add_centre(to, baseline.normalized(), direction);
    add_centre(from, -baseline.normalized(), direction);
    double variance = covariance_->variance(direction);
    // Errors of fixed numbers move the unknowns.
    if (std::isfinite(variance) && !fixed_.empty())
      variance += (by_fixed_.transpose() * covariance_->times(direction)).squaredNorm();
    return std::sqrt(variance) / baseline.norm();
  }

  Eigen::MatrixXd covariance_of_places(std::span<const PlaceIndex> places) {
    const auto count = 3 * static_cast<Eigen::Index>(places.size());
    Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(unknowns_, count), moved = directions;
    Eigen::VectorXd undetermined = Eigen::VectorXd::Zero(count);
    for (Eigen::Index row = 0; row < count; ++row) {
      add_coordinate(places[static_cast<std::size_t>(row / 3)], row % 3, directions.col(row));
      if (directions.col(row).isZero(0)) continue;  // a constant pose
      if (std::isfinite(covariance_->variance(directions.col(row))))
        moved.col(row) = covariance_->times(directions.col(row));
      else
        undetermined(row) = kInfinite;
    }
    Eigen::MatrixXd covariance = directions.transpose() * moved;
    if (!fixed_.empty()) {
      const Eigen::MatrixXd by_fixed = by_fixed_.transpose() * moved;
      covariance += by_fixed.transpose() * by_fixed;
    }
    covariance.diagonal() += undetermined;
    return covariance;
  }

  // Uncertainty::shape_sigma and Uncertainty::least_linked.
  void find_shape(Uncertainty& result) {
    const std::vector<std::size_t> images = sample_of_images();
    const auto count = static_cast<Eigen::Index>(images.size());
    Eigen::Matrix3Xd centres(3, count);
    Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(unknowns_, 3 * count), moved = directions;
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t image = images[static_cast<std::size_t>(i)];
      centres.col(i) = bundle_.images[image].pose.centre;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Index column = 3 * i + k;
        Eigen::VectorXd direction = Eigen::VectorXd::Zero(unknowns_);
        add_centre(image, Eigen::Vector3d::Unit(k), direction);
        directions.col(column) = direction;
        moved.col(column) = covariance_->times(direction);
      }
    }
    const Eigen::MatrixXd covariance = directions.transpose() * moved;
    const Eigen::VectorXd sigmas = sigmas_after_similarity(centres, covariance);
    Eigen::Index largest = 0;
    sigmas.maxCoeff(&largest);
    result.least_linked = images[static_cast<std::size_t>(largest)];
    const double sigma = std::sqrt(sigmas.squaredNorm() / static_cast<double>(count));
    const double extent = (centres.colwise() - centres.col(0)).colwise().norm().maxCoeff();
    result.shape_sigma = sigma < extent ? sigma / median_distance(bundle_) : kInfinite;
  }

 private:
  // Up to 16 images with observations, spread evenly over all of them.
  std::vector<std::size_t> sample_of_images() const {
    std::vector<std::size_t> observed;
    for (std::size_t i = 0; i < bundle_.images.size(); ++i)
      if (problem_.is_observed(i)) observed.push_back(i);
    std::vector<std::size_t> sample;
    for (const std::size_t k : spread_indices(observed.size(), 16)) sample.push_back(observed[k]);
    return sample;
  }

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
    if (found == columns_.end()) return;
    for (int k = 0; k < 3; ++k)
      direction(unknown_of_column_[static_cast<std::size_t>(found->second + 3 + k)]) += along(k);
  }

  void add_coordinate(const PlaceIndex& place, Eigen::Index axis,
                      Eigen::Ref<Eigen::VectorXd> direction) {
    const bool is_image = place.of == KnownDistance::Between::images;
    const double* const block = is_image ? problem_.image_block(place.index)
                                         : problem_.point_block(point_of(bundle_, place.index));
    const auto found = columns_.find(block);
    if (found == columns_.end()) return;
    const Eigen::Index column = found->second + (is_image ? 3 : 0) + axis;
    direction(unknown_of_column_[static_cast<std::size_t>(column)]) = 1;
  }

  // The column of a number of a camera; nothing if it has none.
  std::optional<std::size_t> column_of(std::size_t camera, int number) {
    const auto& free = all_.unknowns(bundle_.cameras[camera]).free;
    const auto found = columns_.find(problem_.change_block(camera));
    if (found == columns_.end() || !free[static_cast<std::size_t>(number)]) return {};
    return static_cast<std::size_t>(found->second +
                                    std::count(free.begin(), free.begin() + number, true));
  }

  // With fewer images, the parts of the work take less than a second.
  bool is_long() const { return bundle_.images.size() >= options_.many_images; }

  // Finds the columns of fixed numbers, and gives the others the numbers of the unknowns.
  void select_columns(Eigen::Index columns) {
    unknown_of_column_.assign(static_cast<std::size_t>(columns), 0);
    for (std::size_t camera = 0; camera < bundle_.cameras.size(); ++camera)
      for (int k = 0; !bundle_.cameras[camera].same_as && k < kHousingNumbers; ++k) {
        const auto column = column_of(camera, k);
        const BundleCamera& one = bundle_.cameras[camera];
        if (!column || options_.unknowns(one).free[static_cast<std::size_t>(k)]) continue;
        fixed_.push_back({static_cast<Eigen::Index>(*column), options_.sigma_before(one, k)});
        unknown_of_column_[*column] = kFixed;
      }
    for (Eigen::Index& unknown : unknown_of_column_)
      if (unknown != kFixed) unknown = unknowns_++;
  }

  // The matrix whose product with a matrix of all columns has the columns of the unknowns.
  Sparse selection(Eigen::Index columns) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t column = 0; column < unknown_of_column_.size(); ++column)
      if (const Eigen::Index unknown = unknown_of_column_[column]; unknown != kFixed)
        entries.emplace_back(static_cast<int>(column), static_cast<int>(unknown), 1.0);
    Sparse matrix(columns, unknowns_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  // The same for the fixed numbers, each times its standard deviation.
  Sparse fixed_columns(Eigen::Index columns) const {
    Sparse matrix(columns, static_cast<Eigen::Index>(fixed_.size()));
    Eigen::Index next = 0;
    for (const auto& [column, sigma] : fixed_) matrix.insert(column, next++) = sigma;
    return matrix;
  }

  struct FixedNumber {
    Eigen::Index column;
    double sigma;  // its standard deviation before the adjustment
  };
  static constexpr Eigen::Index kFixed = -1;

  AdjustOptions all_;
  AdjustProblem problem_;
  const Bundle& bundle_;
  const AdjustOptions& options_;
  std::map<const double*, Eigen::Index> columns_;  // first column of each parameter block
  std::vector<FixedNumber> fixed_;
  std::vector<Eigen::Index> unknown_of_column_;  // or kFixed
  Eigen::Index unknowns_ = 0;
  Sparse by_fixed_;  // normal equations of the unknowns (rows) by the fixed numbers, times sigma
  std::optional<Covariance> covariance_;
};

AdjustOptions weighed_by_residuals(const Bundle& bundle, const AdjustOptions& options) {
  AdjustOptions weighed = options;
  weighed.pixel_sigma = observed_pixel_sigma(bundle, options);
  weighed.kept.clear();
  return weighed;
}

}  // namespace

double observed_pixel_sigma(const Bundle& bundle, const AdjustOptions& options) {
  const std::vector<double> all = reprojection_errors(bundle);
  std::vector<double> errors;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const Observation& one = bundle.observations[i]; !(one.target_sigma > 0))
      errors.push_back(all[i] / one.sigma);
  const double residuals = 2.0 * static_cast<double>(errors.size());
  const double free = std::max(1.0, residuals - static_cast<double>(unknowns_of(bundle, options)));
  constexpr double kLeast = 1e-9;  // [px], size of rounding errors
  return std::max(kLeast, root_mean_square(errors) * std::sqrt(residuals / (2 * free)));
}

NumbersCovariance covariance_of_numbers(const Bundle& bundle, const AdjustOptions& options) {
  return Normal(bundle, weighed_by_residuals(bundle, options), {}).covariance_of_numbers();
}

Eigen::MatrixXd covariance_of_places(const Bundle& bundle, const AdjustOptions& options,
                                     std::span<const PlaceIndex> places) {
  return Normal(bundle, weighed_by_residuals(bundle, options), {}).covariance_of_places(places);
}

Uncertainty uncertainty(const Bundle& bundle, const AdjustOptions& options,
                        const Context& context) {
  Uncertainty result;
  const AdjustOptions weighed = weighed_by_residuals(bundle, options);
  result.pixel_sigma = weighed.pixel_sigma;
  Normal normal(bundle, weighed, context);
  for (std::size_t camera = 0; camera < bundle.cameras.size(); ++camera)
    result.camera_sigmas.push_back(normal.sigmas_of_camera(camera));
  for (std::size_t rig = 0; rig < bundle.rigs.size(); ++rig) {
    result.rig_sigmas.emplace_back();
    for (std::size_t camera = 0; camera < bundle.rigs[rig].cameras.size(); ++camera)
      result.rig_sigmas.back().push_back(normal.sigmas_in_rig(rig, camera));
  }
  if (options.poses_known) return result;
  result.scale_sigma = normal.sigma_of_scale();
  normal.find_shape(result);
  return result;
}

}  // namespace axial::pose
