// SPDX-License-Identifier: GPL-3.0-or-later
// The errors of a camera's lens. tests/lens/lens_test.cpp compares the lenses themselves with
// OpenCV.
#include "io/colmap/colmap_lens.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace axial::io {
namespace {

TEST(ColmapLens, WhatCannotBeUndistortedIsNamed) {
  const auto message = [](const ColmapCamera& camera) -> std::string {
    try {
      pinhole_inside(camera, "sparse/0");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({3, "EQUIRECTANGULAR", 640, 320, {640, 320}}),
            "camera 3: model EQUIRECTANGULAR is not supported; undistort its images with COLMAP "
            "first");
  // COLMAP-Underwater's model, which COLMAP does not know.
  EXPECT_EQ(message({3, "METASHAPE_FISHEYE", 640, 480, {700, 700, 320, 240, 0, 0, 0, 0, 0, 0}}),
            "camera 3: model METASHAPE_FISHEYE is not supported; undistort its images with the "
            "program that calibrated it first");
  EXPECT_NE(message({3, "OPENCV_FISHEYE", 640, 480, {700, 700, 900, 240, 0, 0, 0, 0}})
                .find("camera 3 (OPENCV_FISHEYE) cannot be undistorted"),
            std::string::npos);  // the principal point is outside the image
  EXPECT_EQ(message({3, "OPENCV", 640, 480, {700, 700, 320, 240}}),
            "camera 3: model OPENCV has 8 parameters, not 4");
}

}  // namespace
}  // namespace axial::io
