// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cstdint>

#include "io/frames/lost_offset.h"
#include "io/obj/mesh_file.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "io/wrong_input.h"
#include "support/captured_events.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const LocalFrame kOffset{{534000, 3378500, 0}};

class MeshOfScene : public test::FolderTest, public testing::WithParamInterface<const char*> {
 protected:
  // Writes a triangle at `at`, with the offset of `frame` unless it is the world.
  fs::path written(const Eigen::Vector3f& at, const LocalFrame& frame = {}) {
    Mesh mesh;
    for (const Eigen::Vector3f& corner : {Eigen::Vector3f(0, 0, 0), {1, 0, 0}, {0, 1, 0}})
      mesh.vertices.push_back(at + corner);
    mesh.faces.push_back({0, 1, 2});
    const fs::path file = folder_ / (std::string("mesh") + GetParam());
    write_mesh(file, mesh, frame);
    return file;
  }

  // Of read_mesh_of_scene(). That of read_textured_mesh_of_scene() is the same. It refuses a PLY
  // without textures.
  static Eigen::Vector3f first_vertex(const fs::path& file, const Context& context = {}) {
    const Eigen::Vector3f first = read_mesh_of_scene(kOffset, file, context).vertices.front();
    if (file.extension() != ".ply")
      EXPECT_EQ(read_textured_mesh_of_scene(kOffset, file).mesh.vertices.front(), first);
    return first;
  }
};

TEST_P(MeshOfScene, LocalPositionsWithoutAnOffsetStayAsTheyAre) {
  const fs::path file = written({2, 3, 4});
  EXPECT_TRUE(is_without_offset(kOffset, file));
  test::CapturedEvents log;
  EXPECT_EQ(first_vertex(file, log.context), Eigen::Vector3f(2, 3, 4));
  EXPECT_THAT(log.lines, HasSubstr("states no offset; its coordinates count from the scene's "
                                   "offset 534000 3378500 0"));
}

// The floats of the file are exact here.
TEST_P(MeshOfScene, WorldPositionsWithoutAnOffsetAreMovedToTheFrame) {
  const fs::path file = written({534002, 3378503, 4});
  EXPECT_FALSE(is_without_offset(kOffset, file));
  test::CapturedEvents log;
  EXPECT_EQ(first_vertex(file, log.context), Eigen::Vector3f(2, 3, 4));
  EXPECT_EQ(log.lines, "");
}

TEST_P(MeshOfScene, AnOffsetThatIsStatedCounts) {
  const fs::path file = written({2, 3, 4}, LocalFrame{{534010, 3378500, 0}});
  EXPECT_FALSE(is_without_offset(kOffset, file));
  EXPECT_EQ(first_vertex(file), Eigen::Vector3f(12, 3, 4));
}

TEST_P(MeshOfScene, NothingIsLostInTheWorld) {
  EXPECT_FALSE(is_without_offset({}, written({2, 3, 4})));
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshOfScene, testing::Values(".ply", ".obj", ".glb"),
                         [](const auto& info) { return std::string(info.param + 1); });

TEST(MeshOfSceneFile, ErrorsNameTheFile) {
  EXPECT_THAT(test::error_of([] { is_without_offset(kOffset, "/no such/mesh.ply"); }),
              HasSubstr("/no such/mesh.ply"));
}

}  // namespace
}  // namespace axial::io
