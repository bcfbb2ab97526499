// SPDX-License-Identifier: GPL-3.0-or-later
// A COLMAP model for tests, and comparisons of such models.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

#include "io/colmap/colmap.h"

namespace axial::test {

inline io::ColmapModel small_model() {
  io::ColmapModel model;
  model.cameras = {{3, "PINHOLE", 640, 480, {500, 501.5, 320, 240}},
                   {1, "SIMPLE_RADIAL", 64, 48, {50, 32, 24, -0.1}}};
  Pose pose;
  pose.rotation = Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, -2, 3).normalized()).matrix();
  pose.centre = {1, 2, 3};
  model.images = {{7, 3, "left/a b.jpg", pose, {{1.5, 2.5, 100}, {3, 4, io::kNoPoint3D}}},
                  {2, 1, "c.jpg", {}, {}},
                  {4, 1, "d.jpg", {}, {{0.1, 0.2, 100}}}};
  model.points = {{100, {0.1, -2, 3e10}, {1, 128, 255}, 0.7, {{7, 0}, {4, 0}}},
                  {5, {1, 2, 3}, {0, 0, 0}, -1, {}}};
  return model;
}

inline void expect_same(const std::vector<io::ColmapCamera>& a,
                        const std::vector<io::ColmapCamera>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    EXPECT_EQ(a[i].model, b[i].model);
    EXPECT_EQ(a[i].width, b[i].width);
    EXPECT_EQ(a[i].height, b[i].height);
    EXPECT_EQ(a[i].params, b[i].params);
  }
}

inline void expect_same(const std::vector<io::ColmapPoint2D>& a,
                        const std::vector<io::ColmapPoint2D>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].x, b[k].x);
    EXPECT_EQ(a[k].y, b[k].y);
    EXPECT_EQ(a[k].point3d, b[k].point3d);
  }
}

// Files store poses as quaternion and translation, so they are equal up to `rounding`.
inline void expect_same(const io::ColmapModel& a, const io::ColmapModel& b,
                        double rounding = 1e-13) {
  expect_same(a.cameras, b.cameras);
  ASSERT_EQ(a.images.size(), b.images.size());
  for (std::size_t i = 0; i < a.images.size(); ++i) {
    EXPECT_EQ(a.images[i].id, b.images[i].id);
    EXPECT_EQ(a.images[i].camera, b.images[i].camera);
    EXPECT_EQ(a.images[i].name, b.images[i].name);
    EXPECT_LT((a.images[i].pose.rotation - b.images[i].pose.rotation).norm(), rounding / 10);
    EXPECT_LT((a.images[i].pose.centre - b.images[i].pose.centre).norm(), rounding);
    expect_same(a.images[i].points, b.images[i].points);
  }
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].id, b.points[i].id);
    EXPECT_EQ(a.points[i].position, b.points[i].position);
    EXPECT_EQ(a.points[i].color, b.points[i].color);
    EXPECT_EQ(a.points[i].error, b.points[i].error);
    ASSERT_EQ(a.points[i].track.size(), b.points[i].track.size());
    for (std::size_t k = 0; k < a.points[i].track.size(); ++k) {
      EXPECT_EQ(a.points[i].track[k].image, b.points[i].track[k].image);
      EXPECT_EQ(a.points[i].track[k].point2d, b.points[i].track[k].point2d);
    }
  }
}

}  // namespace axial::test
