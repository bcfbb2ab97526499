// SPDX-License-Identifier: GPL-3.0-or-later
#include "belong/surface_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "belong/surface_fit.h"
#include "hilly_scene.h"
#include "support/captured_events.h"

namespace axial::belong {
namespace {

using test::ground;
using test::hilly_scene;
using testing::AllOf;
using testing::HasSubstr;

const SurfaceCheck kNames{"mesh.ply", "scene.mvs"};

// The error or the warnings of the check; empty: the shape passes.
std::string verdict(const Scene& scene, const Shape& shape, const SurfaceCheck& check = kNames) {
  const test::CapturedEvents events;
  try {
    check_surface(scene, shape, check, events.context);
  } catch (const Error& error) {
    return error.what();
  }
  return events.lines;
}

template <class Change>
Mesh changed(Mesh mesh, const Change& change) {
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = change(vertex);
  return mesh;
}

Mesh scaled(const Mesh& mesh, float factor) {
  return changed(mesh, [&](const Eigen::Vector3f& x) { return Eigen::Vector3f(factor * x); });
}

TEST(SurfaceCheck, PassesTheMeshAndTheCloudOfTheScene) {
  const Scene scene = hilly_scene();
  for (const int cells : {20, 60, 200}) {
    const Mesh mesh = ground(0, cells);
    EXPECT_EQ(verdict(scene, shape_of(mesh)), "") << cells;
    EXPECT_EQ(verdict(scene, {mesh.vertices}), "") << cells;
  }
}

TEST(SurfaceCheck, MeasuresPixels) {
  const Scene scene = hilly_scene();
  SurfaceMeasure measure(scene);
  const SurfaceFit fit = measure.fit(shape_of(ground(0, 200)));
  EXPECT_GT(fit.places, 400u);  // of 600 sparse points, those that two images see
  EXPECT_EQ(fit.counted, fit.places);
  EXPECT_LT(fit.distance, 0.2);
  // The mesh of the ground 10 mm lower: a pixel is 1 / (300 px * 1.34) wide. The nearest point of a
  // slope is nearer than 10 mm, and the direction of view is oblique for some of the cameras.
  const Mesh lower = changed(ground(0, 200), [](const Eigen::Vector3f& x) {
    return Eigen::Vector3f(x + Eigen::Vector3f(0, 0, 0.01f));
  });
  const double distance = measure.fit(shape_of(lower)).distance;
  EXPECT_GT(distance, 0.5);
  EXPECT_LT(distance, 0.01 * 300 * 1.34);
}

TEST(SurfaceCheck, FindsTheMeshAndTheCloudOfAnotherPlace) {
  const Scene scene = hilly_scene();
  const Mesh other = ground(1, 200);
  EXPECT_THAT(verdict(scene, shape_of(other)),
              AllOf(HasSubstr("mesh.ply: does not belong to scene.mvs: half of the scene's sparse "
                              "points lie"),
                    HasSubstr("pixels or more from the mesh; is it the mesh of another survey")));
  EXPECT_THAT(verdict(scene, {other.vertices}), HasSubstr("from the cloud; is it the cloud of"));
}

TEST(SurfaceCheck, NamesUnitsAndAxes) {
  const Scene scene = hilly_scene();
  const Mesh mesh = ground(0);
  EXPECT_THAT(verdict(scene, shape_of(scaled(mesh, 1000))),
              HasSubstr("the mesh is 1000 times too large: is it in millimetres?"));
  EXPECT_THAT(verdict(scene, shape_of(scaled(mesh, 0.001f))),
              HasSubstr("1000 times too small: is the scene in millimetres?"));
  EXPECT_THAT(verdict(scene, shape_of(scaled(mesh, 3.28084f))), HasSubstr("is it in feet?"));
  const Mesh turned =
      changed(mesh, [](const Eigen::Vector3f& x) { return Eigen::Vector3f(x.x(), x.z(), -x.y()); });
  EXPECT_THAT(verdict(scene, shape_of(turned)), HasSubstr("wrote x, z, -y for x, y, z"));
}

TEST(SurfaceCheck, IsAWarningWhereItIsDoubtful) {
  const Scene scene = hilly_scene();
  const Mesh lower = changed(ground(0), [](const Eigen::Vector3f& x) {
    return Eigen::Vector3f(x + Eigen::Vector3f(0, 0, 0.018f));
  });
  SurfaceMeasure measure(scene);
  const double distance = measure.fit(shape_of(lower)).distance;
  const double largest = largest_distance(scene, shape_of(lower), 0);
  ASSERT_GT(distance, largest);
  ASSERT_LT(distance, 2 * largest);
  const test::CapturedEvents events;
  EXPECT_NO_THROW(check_surface(scene, shape_of(lower), kNames, events.context));
  EXPECT_THAT(events.lines, HasSubstr("mesh.ply: does not belong to scene.mvs"));
}

TEST(SurfaceCheck, OnlyWarnsOnDemand) {
  const Scene scene = hilly_scene();
  const test::CapturedEvents events;
  EXPECT_NO_THROW(check_surface(scene, shape_of(scaled(ground(0), 1000)),
                                {"mesh.ply", "scene.mvs", true}, events.context));
  EXPECT_THAT(events.lines, HasSubstr("millimetres"));
}

TEST(SurfaceCheck, PassesAPartOfTheMesh) {
  const Scene scene = hilly_scene(2000);
  Mesh part = ground(0, 200);
  std::erase_if(part.faces, [&](const auto& face) {
    const Eigen::Vector3f& x = part.vertices[face[0]];
    return x.x() < 0.05f || x.y() < 0.05f;
  });
  EXPECT_EQ(verdict(scene, shape_of(part)), "");
  std::erase_if(part.faces, [&](const auto& face) {
    const Eigen::Vector3f& x = part.vertices[face[0]];
    return x.x() > 0.1f || x.y() > 0.1f;
  });
  EXPECT_EQ(verdict(scene, shape_of(part)), "");
}

TEST(SurfaceCheck, WithoutSparsePointsNeedsACameraThatLooksAtTheMesh) {
  Scene scene = hilly_scene();
  scene.points.clear();
  EXPECT_EQ(verdict(scene, shape_of(ground(0))), "");
  EXPECT_EQ(verdict(scene, shape_of(ground(1))), "");
  const Mesh far = changed(ground(0), [](const Eigen::Vector3f& x) {
    return Eigen::Vector3f(x + Eigen::Vector3f(5000, 0, 0));
  });
  EXPECT_THAT(verdict(scene, shape_of(far)),
              HasSubstr("mesh.ply: no camera of scene.mvs looks at the mesh"));
  // A face that fills the images, but has its corners and its middle outside of them.
  Mesh large;
  large.vertices = {{-50, -50, 1}, {90, -50, 1}, {-50, 90, 1}};
  large.faces = {{0, 1, 2}};
  EXPECT_EQ(verdict(scene, shape_of(large)), "");
}

}  // namespace
}  // namespace axial::belong
