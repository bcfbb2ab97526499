// SPDX-License-Identifier: GPL-3.0-or-later
// Patterns of reprojection errors on simulated surveys: none with the right cameras, and the right
// camera and number with a wrong one.
#include <gtest/gtest.h>

#include "diagnosis/residual_cause.h"
#include "pose/adjust/adjust.h"
#include "pose/survey.h"

namespace axial::diagnosis {
namespace {

using namespace pose;
namespace testing = pose::testing;

using testing::camera_behind;
using testing::dome_port;
using testing::flat_port;
using testing::mixed_survey;
using testing::survey;

using CameraModels = std::vector<CameraModel>;

constexpr double kPixelNoise = 0.5;  // [px]

// The photographs of `bundle`, with cameras as stated by a user.
TrackedPhotographs with_cameras(const Bundle& bundle, const CameraModels& cameras) {
  TrackedPhotographs photographs{cameras, bundle.images, {}, bundle.observations};
  for (const BundlePoint& point : bundle.points) photographs.points.push_back(point.position);
  return photographs;
}

ResidualPattern pattern_of(const TrackedPhotographs& photographs,
                           std::span<const Eigen::Vector2d> freed, std::size_t camera) {
  std::vector<Eigen::Vector2d> pixels, errors;
  for (std::size_t i = 0; i < freed.size(); ++i)
    if (photographs.images[photographs.observations[i].image].camera == camera) {
      pixels.push_back(photographs.observations[i].pixel);
      errors.push_back(freed[i]);
    }
  const CameraModel& model = photographs.cameras[camera];
  return residual_pattern(pixels, errors, model.width, model.height);
}

Bundle survey_of(const CameraModel& camera, unsigned seed) {
  return survey(camera, {0.8, 16, 500, kPixelNoise, seed});
}

Bundle survey_of_two(const CameraModel& first, const CameraModel& second, unsigned seed) {
  return mixed_survey(first, second, {0.8, 24, 600, kPixelNoise, seed});
}

// Truth and statement of a fault of the second of two cameras.
struct WrongCamera {
  const char* name;
  CameraModel truth, stated;
  double change;  // of the first number of the cause
};

CameraModel with_index(refractive::FlatPort<double> port, double index) {
  port.n_water = index;
  return camera_behind(port);
}

CameraModel with_focal(double factor) {
  CameraModel camera = camera_behind(flat_port());
  camera.lens.fx *= factor;
  camera.lens.fy *= factor;
  return camera;
}

CameraModel with_dome_centre(double x, double z) {
  refractive::DomePort<double> port = dome_port();
  port.centre += Eigen::Vector3d(x, 0, z);
  return camera_behind(port);
}

std::vector<WrongCamera> wrong_cameras() {
  return {
      {"distance of the port", camera_behind(flat_port(0, 0.06)), camera_behind(flat_port(0, 0.03)),
       30},
      {"normal of the port", camera_behind(flat_port(2)), camera_behind(flat_port(0)), 2},
      {"index of the water", with_index(flat_port(), 1.345), with_index(flat_port(), 1.333), 0.012},
      {"focal length", with_focal(1.01), with_focal(1), 6.1},
      {"x of the dome's centre", with_dome_centre(0.004, 0), with_dome_centre(0, 0), 4},
      {"z of the dome's centre", with_dome_centre(0, 0.004), with_dome_centre(0, 0), 4}};
}

TEST(ResidualPattern, IsNotReportedForTheRightCameras) {
  int reported = 0, judged = 0;
  double squares = 0, degrees = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const CameraModel camera = seed % 2 ? camera_behind(flat_port(2)) : camera_behind(dome_port());
    const TrackedPhotographs photographs = with_cameras(survey_of(camera, seed), {camera});
    const ResidualVectors vectors = residual_vectors(photographs);
    const ResidualPattern pattern = pattern_of(photographs, vectors.freed, 0);
    reported += pattern.found();
    judged += pattern.tells();
    squares += pattern.chi_square;
    degrees += pattern.degrees;
    EXPECT_NEAR(pattern.noise, kPixelNoise, 0.05 * kPixelNoise);
  }
  EXPECT_EQ(judged, 40);
  EXPECT_EQ(reported, 0);
  EXPECT_NEAR(squares / degrees, 1, 0.05);
}

void expect_cause(const TrackedPhotographs& photographs, const ResidualVectors& vectors,
                  const WrongCamera& fault) {
  const std::vector<std::size_t> suspects{0, 1};
  const std::vector<Cause> causes = residual_causes(photographs, vectors.freed, suspects);
  ASSERT_FALSE(causes.empty());
  EXPECT_EQ(causes[0].camera, 1u);
  EXPECT_EQ(causes[0].name, fault.name);
  EXPECT_GT(causes[0].share, 0.7);
  EXPECT_NEAR(causes[0].numbers[0].change, fault.change, 0.25 * fault.change);
}

TEST(ResidualPattern, IsReportedForTheWrongOneOfTwoCamerasWithItsNumber) {
  for (const WrongCamera& fault : wrong_cameras()) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(fault.name + std::to_string(seed));
      const CameraModel right = camera_behind(flat_port(1, 0.03));
      const Bundle bundle = survey_of_two(right, fault.truth, seed);
      const TrackedPhotographs photographs = with_cameras(bundle, {right, fault.stated});
      const ResidualVectors vectors = residual_vectors(photographs);
      EXPECT_FALSE(pattern_of(photographs, vectors.freed, 0).found());
      EXPECT_TRUE(pattern_of(photographs, vectors.freed, 1).found());
      expect_cause(photographs, vectors, fault);
    }
  }
}

// Refines poses and points with the cameras. The scale is known.
void refine_with(const CameraModels& cameras, Bundle& bundle) {
  for (std::size_t i = 0; i < cameras.size(); ++i)
    bundle.cameras[i].measured = testing::housed(cameras[i]);
  AdjustOptions options;
  options.pixel_sigma = kPixelNoise;
  options.distances = {testing::known_length(bundle)};
  adjust(bundle, options);
}

TEST(ResidualPattern, IsReportedWithItsNumberIfPosesAndPointsAdaptedToTheWrongCamera) {
  for (const WrongCamera& fault : wrong_cameras()) {
    SCOPED_TRACE(fault.name);
    const CameraModel right = camera_behind(flat_port(1, 0.03));
    Bundle bundle = survey_of_two(right, fault.truth, 1);
    const CameraModels stated{right, fault.stated};
    refine_with(stated, bundle);
    const TrackedPhotographs photographs = with_cameras(bundle, stated);
    const ResidualVectors vectors = residual_vectors(photographs);
    EXPECT_TRUE(pattern_of(photographs, vectors.freed, 1).found());
    expect_cause(photographs, vectors, fault);
  }
}

TEST(ResidualPattern, IsNotReportedAfterRefinement) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const CameraModels cameras{camera_behind(flat_port(1, 0.03)), camera_behind(dome_port())};
    Bundle bundle = survey_of_two(cameras[0], cameras[1], seed);
    testing::disturb(bundle, 0.002, 0.002, seed);
    refine_with(cameras, bundle);
    const TrackedPhotographs photographs = with_cameras(bundle, cameras);
    const ResidualVectors vectors = residual_vectors(photographs);
    for (const std::size_t camera : {0u, 1u})
      EXPECT_FALSE(pattern_of(photographs, vectors.freed, camera).found());
  }
}

TEST(ResidualPattern, NamesTheIndexOfAllCamerasIfItIsWrongForAll) {
  const CameraModel flat = camera_behind(flat_port(1, 0.03)), dome = with_dome_centre(0, 0.002);
  CameraModels wrong{flat, dome};
  for (CameraModel& camera : wrong)
    std::visit([](auto& port) { port.n_water = 1.35; }, *camera.port);
  const TrackedPhotographs photographs = with_cameras(survey_of_two(flat, dome, 4), wrong);
  const ResidualVectors vectors = residual_vectors(photographs);
  const std::vector<std::size_t> suspects{0, 1};
  const std::vector<Cause> causes = residual_causes(photographs, vectors.freed, suspects);
  ASSERT_FALSE(causes.empty());
  EXPECT_EQ(causes[0].camera, kAllCameras);
  EXPECT_EQ(causes[0].name, "index of the water");
  EXPECT_NEAR(causes[0].numbers[0].change, -0.017, 0.003);
}

TEST(ResidualPattern, NamesThePortThatPinholeCamerasLackWithOrWithoutAdaptedPoses) {
  const CameraModel truth = camera_behind(flat_port(0, 0.02));
  CameraModel pinhole = camera_behind({});
  for (const double factor : {1.0, 1.333})
    for (const bool adapted : {false, true}) {
      pinhole.lens.fx = factor * truth.lens.fx;
      pinhole.lens.fy = factor * truth.lens.fy;
      Bundle bundle = survey_of(truth, 3);
      if (adapted) refine_with({pinhole}, bundle);
      const TrackedPhotographs photographs = with_cameras(bundle, {pinhole});
      const ResidualVectors vectors = residual_vectors(photographs);
      EXPECT_TRUE(pattern_of(photographs, vectors.freed, 0).found());
      const std::vector<std::size_t> suspects{0};
      const std::vector<Cause> causes = residual_causes(photographs, vectors.freed, suspects);
      ASSERT_FALSE(causes.empty());
      EXPECT_EQ(causes[0].name, "a port that is not modelled");
      EXPECT_GT(causes[0].share, 0.9);
    }
}

}  // namespace
}  // namespace axial::diagnosis
