// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/residuals.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/order_statistics.h"
#include "base/parallel.h"
#include "pose/bundle/observation_cost.h"

namespace axial::diagnosis {
namespace {

constexpr double kOutlier = 4;  // in robust standard deviations

const Eigen::Vector2d kNoError =
    Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

double deviation_of(std::span<const ObservationTerm> terms, const Eigen::Vector<double, 6>& step) {
  std::vector<double> values;
  for (const ObservationTerm& term : terms) {
    const Eigen::Vector2d error = term.error - term.by_pose * step;
    values.insert(values.end(), {error.x(), error.y()});
  }
  return deviation_about_zero(std::move(values));
}

// The change of the pose that fits the terms best.
Eigen::Vector<double, 6> pose_step(std::span<const ObservationTerm> terms) {
  Eigen::Vector<double, 6> step = Eigen::Vector<double, 6>::Zero();
  for (int round = 0; round < 3; ++round) {
    const double limit = kOutlier * deviation_of(terms, step);
    Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Vector<double, 6> b = Eigen::Vector<double, 6>::Zero();
    for (const ObservationTerm& term : terms) {
      if ((term.error - term.by_pose * step).cwiseAbs().maxCoeff() > limit) continue;
      A += term.by_pose.transpose() * term.by_pose;
      b += term.by_pose.transpose() * term.error;
    }
    // Without this, the step of points on a line would not be determined.
    A.diagonal() *= 1 + 1e-9;
    A.diagonal().array() += 1e-12 * A.trace() + std::numeric_limits<double>::min();
    step = A.ldlt().solve(b);
  }
  return step;
}

}  // namespace

ObservationTerm observation_term(const AnyCamera<double>& camera, const Pose& pose,
                                 const Eigen::Vector3d& point, const Eigen::Vector2d& pixel) {
  ObservationTerm term;
  const Eigen::Vector3d X = pose.to_camera(point);
  refractive::Matrix23<double> by_camera_point;
  const refractive::Projection<double> seen = camera.project(X, &by_camera_point);
  term.visible = seen.visible && seen.pixel.allFinite() && by_camera_point.allFinite();
  if (!term.visible) return term;
  term.error = pixel - seen.pixel;
  term.by_point = by_camera_point * pose.rotation;
  term.by_pose << -by_camera_point * pose::cross_matrix(X), -term.by_point;
  return term;
}

std::vector<AnyCamera<double>> cameras_of(const TrackedPhotographs& photographs) {
  std::vector<AnyCamera<double>> cameras;
  for (const CameraModel& model : photographs.cameras)
    cameras.emplace_back(make_camera<double>(model));
  return cameras;
}

ResidualVectors residual_vectors(const TrackedPhotographs& photographs) {
  const std::vector<AnyCamera<double>> cameras = cameras_of(photographs);
  const auto of_image = observations_of_each(photographs.observations, &pose::Observation::image,
                                             photographs.images.size());
  ResidualVectors result;
  result.stated.assign(photographs.observations.size(), kNoError);
  result.freed = result.stated;
  parallel_for(of_image.size(), [&](std::size_t number) {
    const pose::BundleImage& image = photographs.images[number];
    std::vector<ObservationTerm> terms;
    std::vector<std::size_t> seen;
    for (const std::size_t i : of_image[number]) {
      const pose::Observation& observation = photographs.observations[i];
      const ObservationTerm term =
          observation_term(cameras[image.camera], image.pose, photographs.points[observation.point],
                           observation.pixel);
      if (!term.visible) continue;
      result.stated[i] = term.error;
      terms.push_back(term);
      seen.push_back(i);
    }
    if (terms.size() < kLeastObservations) return;
    const Eigen::Vector<double, 6> step = pose_step(terms);
    for (std::size_t k = 0; k < seen.size(); ++k)
      result.freed[seen[k]] = terms[k].error - terms[k].by_pose * step;
  });
  return result;
}

}  // namespace axial::diagnosis
