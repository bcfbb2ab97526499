// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the standard deviations of bundle adjustment with a dense inverse.
#include "pose/adjust/uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "pose/bundle/adjust_options.h"
#include "pose/survey.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using testing::flat_port;
using testing::survey;

// The normal equations of all unknowns as a dense matrix, from differences of reprojections.
class DenseNormal {
 public:
  explicit DenseNormal(const Bundle& bundle) : bundle_(bundle) {}

  Eigen::Index unknowns() const {
    return static_cast<Eigen::Index>(6 * (bundle_.images.size() - 1) + 3 * bundle_.points.size()) +
           1;
  }

  // The residuals after unknown `k` has changed by `step`: six numbers of each pose but the first,
  // three of each point, and the refractive index of the water. The last residual is the length
  // between the first and the last image.
  Eigen::VectorXd residuals(Eigen::Index k, double step, double pixel_sigma,
                            double length_sigma) const {
    Bundle moved = bundle_;
    const auto poses = static_cast<Eigen::Index>(6 * (bundle_.images.size() - 1));
    if (k < poses)
      move(moved.images[static_cast<std::size_t>(1 + k / 6)].pose, static_cast<int>(k % 6), step);
    else if (k + 1 < unknowns())
      moved.points[static_cast<std::size_t>((k - poses) / 3)].position((k - poses) % 3) += step;
    else
      moved.cameras[0].change(kIndexNumber) += step;
    const PhotographCamera camera = cameras_now(moved)[0];
    Eigen::VectorXd all(2 * moved.observations.size() + 1);
    for (std::size_t i = 0; i < moved.observations.size(); ++i) {
      const Observation& o = moved.observations[i];
      const Eigen::Vector3d X =
          moved.images[o.image].pose.to_camera(moved.points[o.point].position);
      all.segment<2>(static_cast<Eigen::Index>(2 * i)) = camera.image(X).pixel / pixel_sigma;
    }
    const Eigen::Vector3d length =
        moved.images.back().pose.centre - moved.images.front().pose.centre;
    all(all.size() - 1) = length.norm() / length_sigma;
    return all;
  }

  Eigen::MatrixXd covariance(double pixel_sigma, double length_sigma) const {
    constexpr double kStep = 1e-5;
    Eigen::MatrixXd jacobian(2 * bundle_.observations.size() + 1, unknowns());
    for (Eigen::Index k = 0; k < unknowns(); ++k)
      jacobian.col(k) = (residuals(k, kStep, pixel_sigma, length_sigma) -
                         residuals(k, -kStep, pixel_sigma, length_sigma)) /
                        (2 * kStep);
    const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    return normal.ldlt().solve(Eigen::MatrixXd::Identity(unknowns(), unknowns()));
  }

 private:
  static void move(Pose& pose, int number, double step) {
    if (number >= 3)
      pose.centre(number - 3) += step;
    else
      pose.rotation =
          Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(number)).toRotationMatrix() * pose.rotation;
  }

  const Bundle& bundle_;
};

// Images 1 to 4, points and observations in another order. The first image stays the first, because
// its pose is constant, and the last stays the end of the known length.
Bundle in_another_order(const Bundle& bundle) {
  Bundle other = bundle;
  const std::vector<std::size_t> images{0, 3, 1, 4, 2, 5};
  for (std::size_t i = 0; i < images.size(); ++i) other.images[images[i]] = bundle.images[i];
  const std::size_t last = bundle.points.size() - 1;
  std::ranges::reverse(other.points);
  for (Observation& observation : other.observations) {
    observation.image = images[observation.image];
    observation.point = last - observation.point;
  }
  std::mt19937_64 random(5);
  std::ranges::shuffle(other.observations, random);
  return other;
}

// The differences are exact to about 1e-6, and the normal equations lose a few digits.
TEST(Uncertainty, IsThatOfTheDenseNormalEquations) {
  const Bundle bundle =
      survey(camera_behind(flat_port(2, 0.05)), {.images = 6, .points = 40, .noise = 0.5});
  const double length = (bundle.images[5].pose.centre - bundle.images[0].pose.centre).norm();
  AdjustOptions options;
  options.loss_sigmas = 1e9;
  options.free[kIndexNumber] = true;
  options.distances.push_back(testing::known_length(bundle, 0.02));
  const double pixel_sigma = observed_pixel_sigma(bundle, options);
  const DenseNormal dense(bundle);
  const Eigen::MatrixXd covariance = dense.covariance(pixel_sigma, 0.02 * length);
  const Eigen::Vector3d along =
      (bundle.images[5].pose.centre - bundle.images[0].pose.centre).normalized();
  // The farthest image from the first must be the last.
  for (const BundleImage& image : bundle.images)
    ASSERT_LE((image.pose.centre - bundle.images[0].pose.centre).norm(), length);
  const double of_length =
      std::sqrt(along.dot(covariance.block<3, 3>(6 * 4 + 3, 6 * 4 + 3) * along)) / length;
  const double of_index = std::sqrt(covariance(covariance.rows() - 1, covariance.rows() - 1));
  for (const Bundle& one : {bundle, in_another_order(bundle)}) {
    const Uncertainty found = uncertainty(one, options);
    EXPECT_NEAR(found.pixel_sigma, pixel_sigma, 1e-9);
    EXPECT_NEAR(found.scale_sigma, of_length, 1e-3 * of_length);
    EXPECT_NEAR(found.camera_sigmas[0](kIndexNumber), of_index, 1e-3 * of_index);
  }
}

}  // namespace
}  // namespace axial::pose
