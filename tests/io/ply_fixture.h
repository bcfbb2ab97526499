// SPDX-License-Identifier: GPL-3.0-or-later
// A fixture for the tests of reading and of writing PLY files.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "io/ply/ply.h"
#include "io/wrong_input.h"

namespace axial::io {

class PlyTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = test::empty_folder();
    file_ = folder_ / "cloud.ply";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  PointCloud cloud(std::string_view bytes) {
    test::put(file_, bytes);
    return read_cloud_ply(file_);
  }
  Mesh mesh(std::string_view bytes) {
    test::put(file_, bytes);
    return read_mesh_ply(file_);
  }
  std::string error(std::string_view bytes) {
    const std::string message = test::error_of([&] { cloud(bytes); });
    EXPECT_THAT(message, testing::HasSubstr(file_.string()));
    return message;
  }

  std::filesystem::path folder_, file_;
};

}  // namespace axial::io
