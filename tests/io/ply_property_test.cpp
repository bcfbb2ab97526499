// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/ply/ply_property.h"

#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/empty_folder.h"

namespace axial::io {
namespace {

class VertexProperties : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path folder_ = test::empty_folder();
  const Mesh mesh_{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}};
};

TEST_F(VertexProperties, GoThroughAFileAndLeaveTheMeshAsItIs) {
  const std::vector<float> values{0.5f, 0.0f, 7.25f};
  const auto file = folder_ / "mesh.ply";
  write_mesh_ply(file, mesh_, VertexProperty{"thickness", values});
  EXPECT_EQ(read_vertex_property(file, "thickness"), values);
  EXPECT_TRUE(read_vertex_property(file, "error").empty());
  const Mesh again = read_mesh_ply(file);
  EXPECT_EQ(again.vertices, mesh_.vertices);
  EXPECT_EQ(again.faces, mesh_.faces);
  EXPECT_THROW(write_mesh_ply(file, mesh_, VertexProperty{"thickness", {}}), Error);
}

TEST_F(VertexProperties, AreFoundBehindListsAndOtherElementsAndInText) {
  const auto file = folder_ / "cloud.ply";
  write_atomically(
      file,
      "ply\nformat ascii 1.0\nelement other 1\nproperty float error\nelement vertex 2\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property list uchar uint view_indices\nproperty float error\n"
      "end_header\n9\n0 0 0 2 4 5 0.25\n1 1 1 0 0.5\n");
  EXPECT_EQ(read_vertex_property(file, "error"), (std::vector<float>{0.25f, 0.5f}));
  EXPECT_TRUE(read_vertex_property(file, "view_indices").empty()) << "a list";
}

TEST_F(VertexProperties, OfATruncatedFileAreAnError) {
  const auto file = folder_ / "mesh.ply";
  write_mesh_ply(file, mesh_, VertexProperty{"thickness", std::vector<float>{1, 2, 3}});
  const std::string bytes = read_file(file);
  write_atomically(file, bytes.substr(0, bytes.find("end_header\n") + 11 + 20));
  EXPECT_THROW(read_vertex_property(file, "thickness"), Error);
}

}  // namespace
}  // namespace axial::io
