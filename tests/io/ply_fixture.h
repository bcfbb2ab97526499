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

class PlyTest : public test::FolderTest {
 protected:
  PointCloud cloud(std::string_view bytes) {
    test::put(file_, bytes);
    return read_cloud_ply(file_);
  }
  Mesh mesh(std::string_view bytes) {
    test::put(file_, bytes);
    return read_mesh_ply(file_);
  }
  std::string error(std::string_view bytes) {
    return test::error_naming(file_, [&] { cloud(bytes); });
  }

  std::filesystem::path file_ = folder_ / "cloud.ply";
};

}  // namespace axial::io
