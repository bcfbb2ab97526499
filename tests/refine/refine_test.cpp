// SPDX-License-Identifier: GPL-3.0-or-later
#include "axial/refine.h"

#include <gmock/gmock.h>

#include <limits>
#include <map>

#include "base/parallel.h"
#include "refine/memory.h"
#include "refine/photographed_mesh.h"
#include "support/error_of.h"

namespace axial::refine {
namespace {

using test::Optics;
using test::PhotographedMesh;
using testing::HasSubstr;

// Rendered once.
const PhotographedMesh& photographed(Optics optics) {
  static std::map<Optics, PhotographedMesh> scenes;
  return scenes.try_emplace(optics, optics).first->second;
}

class Refine : public testing::TestWithParam<Optics> {};

TEST_P(Refine, ReducesNoiseByMoreThanHalf) {
  const PhotographedMesh& scene = photographed(GetParam());
  Mesh mesh = scene.mesh(0.004);  // half a pixel
  const double before = scene.error(mesh);
  const Report report = scene.refine(mesh);
  EXPECT_LT(scene.error(mesh), 0.5 * before);
  EXPECT_GT(report.measured, mesh.vertices.size() / 2);
  EXPECT_EQ(report.split_faces, 0u);
}

TEST_P(Refine, KeepsATrueMesh) {
  const PhotographedMesh& scene = photographed(GetParam());
  Mesh mesh = scene.mesh(0);
  scene.refine(mesh);
  // A tenth of a pixel: the images are rounded to grey levels, and flat faces cut the sphere.
  EXPECT_LT(scene.error(mesh), 0.0008);
}

INSTANTIATE_TEST_SUITE_P(Cameras, Refine,
                         testing::Values(Optics::pinhole, Optics::distorted, Optics::flat_port));

TEST(Refine, FindsTheWayFromAWrongHeight) {
  const PhotographedMesh& scene = photographed(Optics::pinhole);
  Mesh mesh = scene.mesh(0);
  for (Eigen::Vector3f& v : mesh.vertices) v.z() += 0.02f;  // up to a pixel between two views
  scene.refine(mesh);
  EXPECT_LT(scene.error(mesh), 0.002);
}

TEST(Refine, APortThatIsIgnoredSpoilsTheMesh) {
  const PhotographedMesh& scene = photographed(Optics::flat_port);
  Mesh with_port = scene.mesh(0.004), without = with_port;
  scene.refine(with_port);
  PhotographedMesh ignorant = scene;
  for (PosedCamera& view : ignorant.views) view.camera.port.reset();
  ignorant.refine(without);
  EXPECT_LT(2 * scene.error(with_port), scene.error(without));
}

TEST(Refine, WithoutTextureTheMeshStays) {
  PhotographedMesh scene = photographed(Optics::pinhole);
  for (Picture& picture : scene.pictures)
    picture.grey = cv::Mat1b(picture.grey.size(), std::uint8_t{100});
  const Mesh before = scene.mesh(0.004);
  Mesh mesh = before;
  const Report report = scene.refine(mesh);
  EXPECT_EQ(report.measured, 0u);
  EXPECT_TRUE(mesh.vertices == before.vertices);
}

TEST(Refine, MaskedPixelsAreNotUsed) {
  PhotographedMesh scene = photographed(Optics::pinhole);
  for (Picture& picture : scene.pictures) {
    picture.grey = picture.grey.clone();
    picture.mask = cv::Mat1b(picture.grey.size(), std::uint8_t{255});
    picture.mask.rowRange(0, 75) = 0;
    // Without the mask, these grey levels would move the vertices.
    cv::flip(picture.grey.rowRange(0, 75), picture.grey.rowRange(0, 75), 1);
  }
  const Mesh before = scene.mesh(0.004);
  Mesh mesh = before;
  scene.refine(mesh);
  std::size_t moved_below = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const bool moved = mesh.vertices[v] != before.vertices[v];
    // The views see this part of the mesh in their masked rows only.
    if (before.vertices[v].y() < -0.25f) {
      EXPECT_FALSE(moved) << v;
    }
    moved_below += moved && before.vertices[v].y() > 0.25f ? 1 : 0;
  }
  EXPECT_GT(moved_below, mesh.vertices.size() / 10);
}

TEST(Refine, TheResultDoesNotDependOnThreadsAndMemory) {
  const PhotographedMesh& scene = photographed(Optics::flat_port);
  Mesh one = scene.mesh(0.004), two = one;
  {
    const ThreadLimit limit(1);
    scene.refine(one);
  }
  const ThreadLimit limit(2);
  // Enough for the images of the vertices of two views, of six.
  const Sizes sizes{one.vertices.size(), one.faces.size(), scene.views.size(), 200 * 150};
  const auto little = MemoryBudget::of_bytes(bytes_needed(sizes, 2));
  ASSERT_EQ(views_to_keep(sizes, {}, little), 2u);
  ASSERT_GT(sizes.views, 2u);
  scene.refine(two, {}, Context({}, {}, {little}));
  EXPECT_TRUE(one.vertices == two.vertices);
  const Context less({}, {}, {MemoryBudget::of_bytes(1'000'000)});
  EXPECT_THAT(test::error_of([&] { scene.refine(two, {}, less); }),
              testing::StartsWith("max_memory: refining a mesh of 5476 vertices needs "));
}

TEST(Refine, EveryChoiceOfReferencesReducesNoise) {
  const PhotographedMesh& scene = photographed(Optics::pinhole);
  for (const References references :
       {References::alternating, References::first, References::second}) {
    Mesh mesh = scene.mesh(0.004);
    const double before = scene.error(mesh);
    Options options;
    options.references = references;
    scene.refine(mesh, options);
    EXPECT_LT(scene.error(mesh), 0.6 * before) << static_cast<int>(references);
  }
}

TEST(Refine, SplitsFacesThatAreLargerThanSomePixels) {
  const PhotographedMesh& scene = photographed(Optics::pinhole);
  Mesh split = scene.mesh(0, 0.1), whole = split;  // the area of a face is about 60 pixels
  const Report report = scene.refine(split);
  EXPECT_GT(report.split_faces, split.faces.size() / 2);
  Options options;
  options.max_face_area = 0;
  EXPECT_EQ(scene.refine(whole, options).split_faces, 0u);
  EXPECT_LT(2 * scene.error_of_faces(split), scene.error_of_faces(whole));
}

TEST(Refine, RefusesWrongMeshes) {
  const PhotographedMesh& scene = photographed(Optics::pinhole);
  const auto error_of = [&](auto&& spoil) {
    Mesh mesh = scene.mesh(0);
    spoil(mesh);
    return test::error_of([&] { scene.refine(mesh); });
  };
  EXPECT_EQ(error_of([](Mesh& mesh) { mesh.faces.clear(); }), "the mesh has no faces");
  EXPECT_THAT(error_of([](Mesh& mesh) { mesh.faces[3][1] = 1'000'000; }),
              HasSubstr("face 3 refers to vertex 1000000, but there are 5476"));
  EXPECT_THAT(error_of([](Mesh& mesh) { mesh.colors.resize(5); }),
              HasSubstr("5 colours, but 5476 vertices"));
  EXPECT_THAT(
      error_of([](Mesh& mesh) { mesh.vertices[7].y() = std::numeric_limits<float>::infinity(); }),
      HasSubstr("vertex 7 is not finite"));
  EXPECT_THAT(error_of([](Mesh& mesh) {
                for (Eigen::Vector3f& v : mesh.vertices) v.z() = -v.z();
              }),
              HasSubstr("no two views see the same part of the mesh"));
}

}  // namespace
}  // namespace axial::refine
