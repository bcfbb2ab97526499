// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/pictures.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "evaluate/report.h"
#include "evaluate/shapes.h"
#include "geometry/sampling.h"
#include "worlds/ports.h"

namespace axial::evaluate {
namespace {

TEST(ErrorColors, RunFromBlueToRedAndStayThere) {
  const Rgb none = error_color(0, 0.01), half = error_color(0.005f, 0.01);
  const Rgb full = error_color(0.01f, 0.01);
  EXPECT_GT(none[2], none[0]);
  EXPECT_GT(half[1], half[0]);
  EXPECT_GT(half[1], half[2]);
  EXPECT_GT(full[0], full[1] + full[2]);
  EXPECT_EQ(error_color(1, 0.01), full);
  EXPECT_EQ(error_color(std::numeric_limits<float>::quiet_NaN(), 0.01), (Rgb{0, 0, 0}));
}

TEST(DrawCloud, ShowsPointsWhereTheCameraSeesThemNearestFirst) {
  const View view{test::camera_at({0, 0, 0}, 200, 100, 100)};
  const Viewpoint at = viewpoint_of(view, 100);
  EXPECT_EQ(at.height, 50);
  const std::vector<Eigen::Vector3f> points{
      {0.505f, 0.255f, 1}, {1.01f, 0.51f, 2}, {0, 0, -1}, {40, 0, 1}};
  const std::vector<Rgb> colors{{10, 20, 30}, {200, 0, 0}, {0, 200, 0}, {0, 0, 200}};
  const cv::Mat3b picture = draw_cloud(points, colors, at);
  // Half resolution: u = 50 * 0.505 + 49.5 = 74.75, v = 50 * 0.255 + 24.5 = 37.25.
  EXPECT_EQ(picture(37, 75), cv::Vec3b(30, 20, 10));
  cv::Mat1b red;
  cv::inRange(picture, cv::Scalar(0, 0, 200), cv::Scalar(0, 0, 200), red);
  EXPECT_EQ(cv::countNonZero(red), 0) << "hidden by the nearer point";
}

TEST(PrincipalViewpoint, LooksAtThePlaneFromItsFront) {
  auto points = geometry::sample_surface(height_field(10, 2, ripples), 20000, 1);
  for (auto& x : points) x.x() *= 1.5f;  // the shape of the picture
  const std::vector<Eigen::Vector3f> normals(10, Eigen::Vector3f(0, 0, 1));
  const Viewpoint view = principal_viewpoint(points, normals, 300, 200);
  EXPECT_LT(view.pose.rotation(2, 2), -0.95);
  EXPECT_NEAR(view.pose.rotation.determinant(), 1, 1e-9);
  const std::vector<Rgb> black(points.size(), Rgb{0, 0, 0});
  const cv::Mat3b picture = draw_cloud(points, black, view);
  cv::Mat1b dark;
  cv::inRange(picture, cv::Scalar::all(0), cv::Scalar::all(0), dark);
  // It fills the picture except for the margin of 5 %.
  EXPECT_NEAR(cv::countNonZero(dark), 300 * 200 * 0.95 * 0.95, 3000);
}

TEST(DrawDepthComparison, PutsThreePanelsInARow) {
  const cv::Mat1f truth(60, 80, 2.0f);
  cv::Mat1f estimate = truth.clone();
  estimate += 0.001f;
  estimate(10, 10) = 0;
  const DepthEvaluation e = evaluate_depth(estimate, truth, {});
  const cv::Mat3b picture = draw_depth_comparison(estimate, e, 0.01);
  EXPECT_EQ(picture.cols, 3 * 88);
  EXPECT_EQ(picture(28 + 10, 4 + 10), cv::Vec3b(60, 60, 60));
  EXPECT_EQ(picture(28 + 10, 176 + 4 + 10), cv::Vec3b(60, 60, 60));
  EXPECT_NE(picture(28 + 11, 176 + 4 + 11), cv::Vec3b(60, 60, 60));
  EXPECT_EQ(with_error_scale(picture, 0.01).cols, picture.cols);
}

TEST(Report, TablesAreInMillimetresAndJsonInMetres) {
  const Mesh truth = flat_square(2, 0);
  const std::vector<Eigen::Vector3f> points{{0, 0, 0.002f}, {0.5f, 0.5f, 0.004f}};
  CloudOptions options;
  options.samples = 100;
  const CloudEvaluation e = evaluate_cloud(points, truth, geometry::Surface(truth), {}, options);
  EXPECT_NE(table(e).find("3.000"), std::string::npos) << table(e);
  EXPECT_NE(table(e).find("no cameras given"), std::string::npos);
  const auto json = to_json(e);
  EXPECT_NEAR(json["accuracy"]["mean"].get<double>(), 0.003, 1e-9);
  EXPECT_EQ(json["scores"][0]["precision"], 1.0);
  EXPECT_EQ(json["accuracy_histogram"]["counts"].size(), 80u);
}

}  // namespace
}  // namespace axial::evaluate
