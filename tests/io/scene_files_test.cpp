// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/openmvs/scene_files.h"

#include <gmock/gmock.h>

#include "io/obj/mesh_file.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsSupersetOf;

TEST(SceneFiles, SideFilesHaveTheWholeNameOfTheScene) {
  const fs::path scene = "d.1/reef.2024.mvs", without = "d.1/reef.2024";
  for (const fs::path& name : {scene, without}) {
    EXPECT_EQ(cloud_beside(name), fs::path("d.1/reef.2024.ply"));
    EXPECT_THAT(files_of_scene(SceneFiles{name, "w", {}}),
                IsSupersetOf<fs::path>({name, "d.1/reef.2024.ply", "d.1/reef.2024.housing.json",
                                        "d.1/reef.2024.lenses.json", "d.1/reef.2024.geo.json"}));
  }
}

TEST(SceneFiles, TheHousingThatIsGivenAndTheOneBesideTheSceneBelongToIt) {
  EXPECT_THAT(files_of_scene(SceneFiles{"s.mvs", "w", "port.json"}),
              IsSupersetOf<fs::path>({"port.json", "s.housing.json"}));
}

TEST(SceneFiles, FilesOfImagesBelongToTheScene) {
  Scene scene;
  scene.images.resize(1);
  scene.images[0].path = "images/a.jpg";
  scene.images[0].mask_path = "masks/a.png";
  scene.images[0].id = 12;
  EXPECT_THAT(files_of_scene({"s/s.mvs", "w", {}}, scene),
              IsSupersetOf<fs::path>({"images/a.jpg", "masks/a.png", "w/depth0012.dmap",
                                      "w/depth0012.dmap.json", "s/depth0012.dmap", "s/s.ply"}));
}

TEST(MeshFile, TheNameOfTheSceneIsNotTheNameOfAPlyMesh) {
  const fs::path folder = test::empty_folder(), scene = folder / "s.mvs";
  fs::create_directory_symlink(folder, folder / "link");
  for (const fs::path& output :
       {fs::path(), folder / "s.mvs", folder / "s", folder / "s.MVS", folder / "link" / "s.mvs"})
    EXPECT_EQ(mesh_file({scene, output, "ply", false, "_refine"}), folder / "s_refine.ply");
  EXPECT_EQ(mesh_file({scene, folder / "s.mvs", "glb", true, "_refine"}), folder / "s.glb");
  EXPECT_EQ(mesh_file({scene, folder / "s.ply", "ply", false, "_refine"}), folder / "s.ply");
  EXPECT_EQ(mesh_file({scene, folder / "t" / "s.mvs", "ply", false, "_refine"}),
            folder / "t" / "s.ply");
}

TEST(MeshFile, TheTypeOrElseTheExtensionChoosesTheFormat) {
  const auto file = [](const char* output, const char* type, bool given) {
    return mesh_file({"s.mvs", output, type, given, "_mesh"}).string();
  };
  EXPECT_EQ(file("m.glb", "ply", false), "m.glb");
  EXPECT_EQ(file("m.OBJ", "ply", false), "m.obj");
  EXPECT_EQ(file("m.glb", "ply", true), "m.ply");
  EXPECT_EQ(file("scan.v2", "OBJ", true), "scan.v2.obj");
  EXPECT_EQ(file("", "ply", false), "s_mesh.ply");
  EXPECT_THAT(test::error_of([&] { file("m.gltf", "ply", false); }), HasSubstr("m.gltf"));
  EXPECT_THAT(test::error_of([&] { file("m", "stl", true); }), HasSubstr("type stl"));
  EXPECT_THAT(test::error_of([&] { file("m.off", "ply", false); }), HasSubstr(".off"));
}

}  // namespace
}  // namespace axial::io
