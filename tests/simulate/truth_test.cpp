// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "simulate/noise.h"
#include "simulate/presets/presets.h"
#include "simulate/render.h"

namespace axial::simulate {
namespace {

using Eigen::Vector3d;

TriangleMesh random_triangles(std::size_t count) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i < 3 * count; ++i) {
    const auto draw = [&](std::uint64_t k) { return uniform(5, 6 * i + k); };
    const Vector3d centre(1.6 * uniform(6, i / 3 * 3) - 0.8, 1.2 * uniform(6, i / 3 * 3 + 1) - 0.6,
                          0.5 + 1.0 * uniform(6, i / 3 * 3 + 2));
    const Vector3d offset(draw(0) - 0.5, draw(1) - 0.5, draw(2) - 0.5);
    mesh.vertices.push_back((centre + 0.5 * offset).cast<float>());
  }
  for (std::uint32_t i = 0; i < count; ++i) mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  return mesh;
}

struct Brute {
  double distance = 1e30;
  Vector3d normal = Vector3d::Zero();
  bool near_an_edge = false;  // near an edge of a triangle float and double may disagree
};

// Solves a linear system for every triangle, in double.
Brute brute_force(const TriangleMesh& mesh, const Vector3d& origin, const Vector3d& direction) {
  Brute nearest;
  for (const auto& [i, j, k] : mesh.faces) {
    const Vector3d a = mesh.vertices[i].cast<double>();
    const Vector3d ab = mesh.vertices[j].cast<double>() - a;
    const Vector3d ac = mesh.vertices[k].cast<double>() - a;
    Eigen::Matrix3d system;
    system << ab, ac, -direction;
    const Vector3d solution = system.fullPivLu().solve(origin - a);
    const double inside = std::min({solution.x(), solution.y(), 1 - solution.x() - solution.y()});
    if (!(solution.z() > 0)) continue;
    if (std::abs(inside) < 1e-4) nearest.near_an_edge = true;
    if (inside < 0 || solution.z() >= nearest.distance) continue;
    nearest.distance = solution.z();
    nearest.normal = ab.cross(ac).normalized();
  }
  return nearest;
}

View tilted_view() {
  const double s = std::sin(0.1), c = std::cos(0.1);
  View view;
  view.rotation << c, 0, -s, 0, 1, 0, s, 0, c;
  view.centre = {0.1, -0.05, -0.2};
  return view;
}

void compare_with_brute_force(const Port* port) {
  const TriangleMesh mesh = random_triangles(60);
  const Lens lens = make_lens(60, 40, 80);
  const View view = tilted_view();
  const Truth truth = render_truth(RayScene(mesh), lens, port, view);
  int hits = 0, compared = 0;
  for (int y = 0; y < lens.height; ++y) {
    for (int x = 0; x < lens.width; ++x) {
      const SceneRay ray = to_world(view, *trace_pixel(lens, port, x, y));
      const Brute expected = brute_force(mesh, ray.start, ray.direction);
      if (expected.near_an_edge) continue;
      ++compared;
      if (expected.distance > 1e29) {
        EXPECT_EQ(truth.distance(y, x), 0);
        continue;
      }
      ++hits;
      const Vector3d point = ray.start + expected.distance * ray.direction;
      const double distance = (point - ray.on_axis).norm();
      EXPECT_NEAR(truth.distance(y, x), distance, 1e-5 * distance) << x << ", " << y;
      const Vector3d normal(truth.normal(y, x)[0], truth.normal(y, x)[1], truth.normal(y, x)[2]);
      EXPECT_NEAR((normal - expected.normal).norm(), 0, 1e-6);
    }
  }
  EXPECT_GT(hits, 500);  // enough hits to compare
  EXPECT_GT(compared, 2000);
}

TEST(Truth, AgreesWithBruteForceInAir) {
  compare_with_brute_force(nullptr);
}

TEST(Truth, AgreesWithBruteForceUnderWater) {
  const Port port{tilted_normal(5), 0.03, 0.018, 1, 1.49, 1.333};
  compare_with_brute_force(&port);
}

TEST(Truth, AgreesWithBruteForceBehindADome) {
  Port port{{0, 0, 1}, 0, 0.01, 1, 1.49, 1.333};
  port.dome = Dome{{0.004, -0.003, -0.006}, 0.05};
  compare_with_brute_force(&port);
}

// A small scene with all its parts.
struct SmallScene {
  TriangleMesh mesh;
  cv::Mat3b image;
  Truth truth;
};

SmallScene small_scene(const std::string& name) {
  Preset preset = make_preset({name, 3, 0, 64, 48, 80});
  preset.terrain.cell *= 8;
  SmallScene small{terrain_mesh(preset.terrain), {}, {}};
  const RayScene scene(small.mesh);
  const Shader shader = seabed_shader(small.mesh, scene, preset.texture);
  const View& view = preset.views.front();
  small.image = develop(render_radiance(scene, shader, preset.lens, &preset.port, view, 2), 1.2, 9);
  small.truth = render_truth(scene, preset.lens, &preset.port, view);
  return small;
}

template <class Pixel>
bool same_bytes(const cv::Mat_<Pixel>& a, const cv::Mat_<Pixel>& b) {
  return a.size() == b.size() && a.isContinuous() && b.isContinuous() &&
         std::equal(a.data, a.data + a.total() * a.elemSize(), b.data);
}

TEST(Truth, DoesNotDependOnTheNumberOfThreads) {
  for (const char* name : {"reef", "closeup"}) {
    const auto with_threads = [&](unsigned threads) {
      const ThreadLimit limit(threads);
      return small_scene(name);
    };
    const SmallScene one = with_threads(1), two = with_threads(2);
    EXPECT_EQ(one.mesh.vertices, two.mesh.vertices);
    EXPECT_EQ(one.mesh.faces, two.mesh.faces);
    EXPECT_TRUE(same_bytes(one.image, two.image));
    EXPECT_TRUE(same_bytes(one.truth.distance, two.truth.distance));
    EXPECT_TRUE(same_bytes(one.truth.normal, two.truth.normal));
  }
}

TEST(Truth, NoiseHasTheStrengthAskedFor) {
  const cv::Mat3f grey(100, 100, cv::Vec3f(0.5f, 0.5f, 0.5f));
  cv::Scalar mean, deviation;
  cv::meanStdDev(develop(grey, 3.0, 1), mean, deviation);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(mean[c], 127.5, 0.15);     // five standard errors
    EXPECT_NEAR(deviation[c], 3.0, 0.12);  // rounding adds 1/12 to the variance
  }
  EXPECT_FALSE(same_bytes(develop(grey, 3.0, 1), develop(grey, 3.0, 2)));
}

TEST(Truth, HazeTakesContrastAndNothingElse) {
  cv::Mat3f light(1, 3);
  light(0, 0) = {0, 0.2f, 0.5f};
  light(0, 1) = {0.5f, 0.5f, 0.5f};
  light(0, 2) = {1, 0.9f, 0.7f};
  cv::Mat3f hazy = light.clone();
  add_haze(hazy, 0.75);
  for (int x = 0; x < 3; ++x)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(hazy(0, x)[c] - 0.5f, 0.25f * (light(0, x)[c] - 0.5f), 1e-6f);  // rounding
  cv::Mat3f clear = light.clone();
  add_haze(clear, 0);
  EXPECT_TRUE(same_bytes(clear, light));
}

TEST(Truth, RefusesAMeshItCannotTrace) {
  EXPECT_THROW(RayScene(TriangleMesh{}), Error);
  EXPECT_THROW(RayScene(TriangleMesh{{{0, 0, 0}}, {{0, 0, 1}}}), Error);
}

}  // namespace
}  // namespace axial::simulate
