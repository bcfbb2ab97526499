// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/information.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "pose/bundle/observation_cost.h"
#include "scene/decompositions.h"

namespace axial::calibrate {
namespace {

using pose::kHousingNumbers;
using pose::kPoseNumbers;

struct Derivatives {
  Eigen::Matrix<double, 2, kPoseNumbers, Eigen::RowMajor> by_pose;
  Eigen::Matrix<double, 2, kHousingNumbers, Eigen::RowMajor> by_change;
};

Derivatives derivatives(const pose::Bundle& bundle, const pose::Observation& observation,
                        const pose::PresentCamera& now) {
  const pose::BundleCamera& camera = bundle.cameras[0];
  const Pose& start = bundle.images[observation.image].pose;
  const pose::ObservationCost cost(observation, start, camera, now);
  const pose::PoseNumbers numbers = pose::numbers_of(start);
  const double* blocks[] = {numbers.data(), bundle.points[observation.point].position.data(),
                            camera.change.data()};
  Derivatives result;
  double residual[2];
  double* jacobians[] = {result.by_pose.data(), nullptr, result.by_change.data()};
  cost.Evaluate(blocks, residual, jacobians);
  return result;
}

}  // namespace

Information information(const pose::Bundle& bundle, std::size_t image) {
  const pose::PresentCamera now(bundle.cameras[0], bundle.cameras[0].change);
  Eigen::Matrix<double, kPoseNumbers, kPoseNumbers> poses;
  Eigen::Matrix<double, kPoseNumbers, kHousingNumbers> across;
  Information result = Information::Zero();
  poses.setZero();
  across.setZero();
  for (const pose::Observation& observation : bundle.observations) {
    if (observation.image != image) continue;
    const Derivatives d = derivatives(bundle, observation, now);
    poses += d.by_pose.transpose() * d.by_pose;
    across += d.by_pose.transpose() * d.by_change;
    result += d.by_change.transpose() * d.by_change;
  }
  // Schur complement: a change that the pose explains as well gives no information.
  return result - across.transpose() * poses.ldlt().solve(across);
}

Information total_information(const pose::Bundle& bundle, const pose::AdjustOptions& options,
                              double pixel_sigma) {
  Information sum = Information::Zero();
  for (std::size_t i = 0; i < bundle.images.size(); ++i) sum += information(bundle, i);
  sum /= pixel_sigma * pixel_sigma;
  for (int k = 0; k < kHousingNumbers; ++k) {
    const double sigma = options.prior_sigma[static_cast<std::size_t>(k)];
    if (sigma > 0) sum(k, k) += 1 / (sigma * sigma);
  }
  return sum;
}

pose::HousingChange<double> sigmas_from(const Information& information,
                                        const pose::AdjustOptions& options) {
  // Scaled to ones on the diagonal. Numbers that are not free stay at the identity.
  Information scaled = Information::Identity();
  pose::HousingChange<double> scale = pose::HousingChange<double>::Zero();
  const auto free = [&](int k) { return options.free[static_cast<std::size_t>(k)]; };
  for (int k = 0; k < kHousingNumbers; ++k)
    if (free(k)) scale(k) = 1 / std::sqrt(std::max(1e-300, information(k, k)));
  for (int i = 0; i < kHousingNumbers; ++i)
    for (int j = 0; j < kHousingNumbers; ++j)
      if (free(i) && free(j)) scaled(i, j) = information(i, j) * scale(i) * scale(j);
  const EigenPairs eigen = symmetric_eigen(scaled);
  constexpr double kLeast = 1e-14;
  const Information vectors = eigen.vectors;
  const pose::HousingChange<double> values = eigen.values;
  const Information covariance =
      vectors * values.cwiseMax(kLeast).cwiseInverse().asDiagonal() * vectors.transpose();
  return scale.cwiseProduct(covariance.diagonal().cwiseSqrt());
}

}  // namespace axial::calibrate
