// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/observation_cost.h"

#include <ceres/jet.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include "pose/survey.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using testing::dome_port;
using testing::flat_port;
using testing::survey;

constexpr int kNumbers = kPoseNumbers + 3 + kHousingNumbers;
using Numbers = Eigen::Matrix<double, kNumbers, 1>;
using Jacobian = Eigen::Matrix<double, 2, kNumbers>;
using Jet = ceres::Jet<double, kNumbers>;

struct Case {
  std::string name;
  std::optional<refractive::Port<double>> port;
  lens::Lens lens;
};

std::ostream& operator<<(std::ostream& out, const Case& one) {
  return out << one.name;
}

class ObservationCostOf : public ::testing::TestWithParam<Case> {
 protected:
  // The points are seen by a lens without distortion, but the cost does not need small residuals.
  Bundle bundle_ = survey(camera_behind(GetParam().port), {});

  void SetUp() override { bundle_.cameras[0].measured = {GetParam().lens, GetParam().port}; }

  // All numbers differ from zero, so that no derivative is right by accident.
  Numbers numbers(const Observation& observation) const {
    const Pose& pose = bundle_.images[observation.image].pose;
    Numbers x;
    x << 0.02, -0.03, 0.05, pose.centre, bundle_.points[observation.point].position, 0.002, -0.003,
        0.001, 0.004, 0.0005, -0.01;
    return x;
  }

  Eigen::Vector2d residual(const Observation& observation, const Numbers& x,
                           Jacobian* jacobian) const {
    const BundleCamera& camera = bundle_.cameras[0];
    const HousingChange<double> change = x.tail<kHousingNumbers>();
    const PresentCamera now(camera, change);
    const ObservationCost cost(observation, bundle_.images[observation.image].pose, camera, now);
    const double* blocks[] = {x.data(), x.data() + kPoseNumbers, x.data() + kPoseNumbers + 3};
    Eigen::Vector2d result;
    Eigen::Matrix<double, 2, kPoseNumbers, Eigen::RowMajor> by_pose;
    Eigen::Matrix<double, 2, 3, Eigen::RowMajor> by_point;
    Eigen::Matrix<double, 2, kHousingNumbers, Eigen::RowMajor> by_change;
    double* jacobians[] = {by_pose.data(), by_point.data(), by_change.data()};
    EXPECT_TRUE(cost.Evaluate(blocks, result.data(), jacobian ? jacobians : nullptr));
    if (jacobian) *jacobian << by_pose, by_point, by_change;
    return result;
  }
};

TEST_P(ObservationCostOf, HasTheDerivativesOfFiniteDifferences) {
  for (std::size_t i = 0; i < bundle_.observations.size(); i += 97) {
    const Observation& seen = bundle_.observations[i];
    const Numbers x = numbers(seen);
    Jacobian jacobian;
    residual(seen, x, &jacobian);
    for (int k = 0; k < kNumbers; ++k) {
      const double h = 1e-6;
      const Numbers step = h * Numbers::Unit(k);
      const Eigen::Vector2d numeric =
          (residual(seen, x + step, nullptr) - residual(seen, x - step, nullptr)) / (2 * h);
      EXPECT_LT((jacobian.col(k) - numeric).norm(), 1e-5 * (1 + numeric.norm())) << "number " << k;
    }
  }
}

// The camera by automatic differentiation alone, unlike the tested code: a pinhole with the focal
// lengths of the lens, and the matcher's formula for its distortion.
template <class Port>
refractive::Vector2<Jet> projection(const Port& port, const refractive::PinholeLens<Jet>& pinhole,
                                    const lens::Lens& lens, const refractive::Vector3<Jet>& X) {
  if constexpr (std::is_same_v<Port, refractive::FlatPort<Jet>>)
    return refractive::FlatPortCamera<Jet>(pinhole, port, lens.width, lens.height).project(X).pixel;
  else
    return refractive::DomePortCamera<Jet>(pinhole, port, lens.width, lens.height).project(X).pixel;
}

refractive::Vector2<Jet> pixel_by_jets(const HousedCamera& camera, const HousingChange<Jet>& change,
                                       const refractive::Vector3<Jet>& X) {
  const auto pinhole = with_change(camera.lens.pinhole, change);
  const refractive::Vector2<Jet> undistorted =
      camera.port ? std::visit(
                        [&](const auto& port) {
                          return projection(with_change(port, change), pinhole, camera.lens, X);
                        },
                        *camera.port)
                  : refractive::PinholeCamera<Jet>(pinhole).project(X).pixel;
  const auto distortion = lens_distortion(camera.lens);
  if (!distortion) return undistorted;
  const auto bends = distortion->cast<Jet>();
  const refractive::Vector3<Jet> bearing = pinhole.bearing(undistorted);
  const auto bent = bends.bent(bends.spread_out({bearing.x(), bearing.y()}).point).point;
  return pinhole.pixel({bent.x(), bent.y(), Jet(1)});
}

TEST_P(ObservationCostOf, HasTheDerivativesOfJets) {
  for (std::size_t i = 0; i < bundle_.observations.size(); i += 97) {
    const Observation& seen = bundle_.observations[i];
    const Numbers x = numbers(seen);
    Jacobian jacobian;
    const Eigen::Vector2d value = residual(seen, x, &jacobian);
    Eigen::Matrix<Jet, kNumbers, 1> jets;
    for (int k = 0; k < kNumbers; ++k) jets(k) = Jet(x(k), k);
    const Pose& pose = bundle_.images[seen.image].pose;
    const refractive::Vector3<Jet> from_centre = jets.segment<3>(kPoseNumbers) - jets.segment<3>(3);
    const refractive::Vector3<Jet> unturned = pose.rotation.cast<Jet>() * from_centre;
    refractive::Vector3<Jet> X;
    ceres::AngleAxisRotatePoint(jets.data(), unturned.data(), X.data());
    const HousingChange<Jet> change = jets.tail<kHousingNumbers>();
    const refractive::Vector2<Jet> expected =
        pixel_by_jets(bundle_.cameras[0].measured, change, X) - seen.pixel.cast<Jet>();
    for (int row = 0; row < 2; ++row) {
      EXPECT_NEAR(value(row), expected(row).a, 1e-9);
      EXPECT_LT((jacobian.row(row).transpose() - expected(row).v).norm(),
                1e-7 * expected(row).v.norm());
    }
  }
}

std::vector<Case> cases() {
  const auto of_model = [](const char* model, std::vector<double> distortion) {
    return lens::Lens{lens::find_model(model), {610, 615, 511.5, 383.5}, distortion, 1024, 768};
  };
  const std::pair<const char*, lens::Lens> lenses[] = {
      {"Pinhole", of_model("PINHOLE", {})},
      {"Perspective", of_model("OPENCV", {-0.12, 0.02, 1e-3, -2e-3})},
      {"Fisheye", of_model("THIN_PRISM_FISHEYE", {0.02, -0.01, 1e-3, 2e-3, 0, 0, 1e-3, -2e-3})}};
  std::vector<Case> cases;
  for (const auto& [name, lens] : lenses) {
    cases.push_back({std::string(name) + "InAir", {}, lens});
    cases.push_back({std::string(name) + "BehindAFlatPort", flat_port(3), lens});
    cases.push_back({std::string(name) + "BehindADome", dome_port(), lens});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Cameras, ObservationCostOf, ::testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

TEST(ObservationCost, APointThatIsNotSeenMovesNothing) {
  const Bundle bundle = survey(camera_behind(flat_port()), {});
  const Observation& seen = bundle.observations[0];
  const PresentCamera now(bundle.cameras[0], bundle.cameras[0].change);
  const ObservationCost cost(seen, bundle.images[seen.image].pose, bundle.cameras[0], now);
  const PoseNumbers pose = numbers_of(bundle.images[seen.image].pose);
  const Eigen::Vector3d behind =
      bundle.images[seen.image].pose.to_world(Eigen::Vector3d(0.01, 0.02, -1));
  const HousingChange<double> change = HousingChange<double>::Zero();
  const double* blocks[] = {pose.data(), behind.data(), change.data()};
  std::array<double, 2> residual;
  std::vector<double> by_pose(2 * kPoseNumbers, 1), by_point(6, 1),
      by_change(2 * kHousingNumbers, 1);
  double* jacobians[] = {by_pose.data(), by_point.data(), by_change.data()};
  ASSERT_TRUE(cost.Evaluate(blocks, residual.data(), jacobians));
  EXPECT_GT(std::hypot(residual[0], residual[1]), 1024);
  for (const auto& derivatives : {by_pose, by_point, by_change})
    for (const double derivative : derivatives) EXPECT_EQ(derivative, 0);
}

TEST(LeftJacobian, TurnsSmoothlyIntoTheIdentity) {
  for (const double angle : {0.0, 1e-9, 9.9e-5, 1.01e-4, 0.3, 3.0}) {
    const Eigen::Vector3d w = angle * Eigen::Vector3d(1, -2, 2) / 3;
    const Eigen::Vector3d v(0.3, 0.5, -0.7);
    const auto turned = [&](const Eigen::Vector3d& by) {
      Eigen::Vector3d result;
      ceres::AngleAxisRotatePoint(by.data(), v.data(), result.data());
      return result;
    };
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-6;
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(k);
      const Eigen::Vector3d numeric = (turned(w + step) - turned(w - step)) / (2 * h);
      EXPECT_LT((numeric - left_jacobian(w).col(k).cross(turned(w))).norm(), 1e-8) << angle;
    }
  }
}

}  // namespace
}  // namespace axial::pose
