// SPDX-License-Identifier: GPL-3.0-or-later
#include "refractive/affine_warp.h"

#include <gtest/gtest.h>

#include "refractive/dome_views.h"
#include "refractive/pixel_lookup.h"
#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

// The paper's stereo setups, in the frame of the reference camera: a plane at a distance of 4 m,
// rotated about y, and a source camera whose axes are parallel to the reference camera's.
struct Setup {
  Vector3<double> source_centre;
  double plane_angle = 0;
};
const Vector3<double> kBaseline(1, 0, 0);
const Vector3<double> kFurther(0.5, 0, -1);

struct Errors {
  double papers = 0, exact_lookup = 0, affine = 0;
};

constexpr int kSize = 2048;
constexpr int kStep = 61;  // between tested centres [px]; testing every pixel would take minutes

// The paper's e_BH: mean distance [px] of the warped pixels of a patch (9x9, step 2) from their
// exact images, over all centres whose patch lies in both images.
template <class Camera>
Errors patch_errors(const Camera& camera, const Setup& setup) {
  const Vector3<double> X0(0, 0, 4);
  const Vector3<double> n = -tilted_normal(setup.plane_angle * kDegree, 0);
  const Matrix3<double> R = Matrix3<double>::Identity();
  const Vector3<double>& C = setup.source_centre;
  const auto in_image = [](const Projection<double>& p) {
    return p.visible && p.pixel.minCoeff() >= 0 && p.pixel.maxCoeff() <= kSize - 1;
  };
  const auto exact_warp = [&](const Vector2<double>& q) {
    const AxialRay<double> ray = camera.ray(q);
    return camera.project(ray.at(plane_intersection(ray, X0, n)) - C);
  };

  Errors sum;
  int texels = 0;
  for (int v = 4; v < kSize - 4; v += kStep) {
    for (int u = 4; u < kSize - 4; u += kStep) {
      const Vector2<double> p(u, v);
      const AxialRay<double> ray = camera.ray(p);
      const double lambda = plane_intersection(ray, X0, n);
      const auto affine = affine_warp(camera, camera, R, C, p, lambda, n);
      if (!affine.visible) continue;
      const Vector2<double> rounded = affine.to.array().round();
      const auto reference = virtual_camera(camera, p);
      const Matrix3<double> H_rounded =
          virtual_homography(reference, virtual_camera(camera, rounded), R, C, ray.at(lambda), n);
      const Matrix3<double> H_exact =
          virtual_homography(reference, virtual_camera(camera, affine.to), R, C, ray.at(lambda), n);
      Errors patch;
      bool complete = true;
      for (int dy = -4; dy <= 4 && complete; dy += 2) {
        for (int dx = -4; dx <= 4; dx += 2) {
          const Vector2<double> q = p + Vector2<double>(dx, dy);
          const Projection<double> exact = exact_warp(q);
          complete = complete && in_image(exact);
          patch.papers += (apply_homography(H_rounded, q) - exact.pixel).norm();
          patch.exact_lookup += (apply_homography(H_exact, q) - exact.pixel).norm();
          patch.affine += (affine(q) - exact.pixel).norm();
        }
      }
      if (!complete) continue;
      texels += 25;
      sum.papers += patch.papers;
      sum.exact_lookup += patch.exact_lookup;
      sum.affine += patch.affine;
    }
  }
  EXPECT_GT(texels, 25 * 100);
  return {sum.papers / texels, sum.exact_lookup / texels, sum.affine / texels};
}

struct Row {
  double fov, distance, tilt;
  Setup setup;
  double papers, exact_lookup, affine;  // expected errors [px], measured over all pixels
};

class WarpTable : public ::testing::TestWithParam<Row> {};

TEST_P(WarpTable, IsReproduced) {
  const Row& row = GetParam();
  const View view{kSize, kSize, lens_with_fov(row.fov, kSize, kSize),
                  paper_port(row.distance, row.tilt)};
  const Errors errors = patch_errors(view.camera<double>(), row.setup);
  report("patch error of the paper's warp [px]", errors.papers);
  report("patch error of the first-order exact warp [px]", errors.affine);
  EXPECT_LE(errors.affine, 0.005);
  // Tolerances: half of the last digit of the expected values, and the sampling of a thousand
  // centres instead of four million.
  EXPECT_NEAR(errors.affine, row.affine, 0.03 * row.affine + 5e-5);
  EXPECT_NEAR(errors.papers, row.papers, 0.02 * row.papers);
  EXPECT_NEAR(errors.exact_lookup, row.exact_lookup, 0.02 * row.exact_lookup);
}

INSTANTIATE_TEST_SUITE_P(Design, WarpTable,
                         ::testing::Values(Row{80, 0.02, 0, {kBaseline, 0}, 0.475, 0.454, 0.0022},
                                           Row{100, 0.02, 0, {kBaseline, 0}, 0.706, 0.685, 0.0034},
                                           Row{80, 0.10, 0, {kBaseline, 0}, 0.462, 0.440, 0.0021},
                                           Row{80, 0.02, 6, {kBaseline, 0}, 0.502, 0.481, 0.0024},
                                           Row{80, 0.02, 0, {kBaseline, -40}, 0.487, 0.463, 0.0025},
                                           Row{80, 0.02, 0, {kFurther, 0}, 0.254, 0.205, 0.0010}));

class WarpBehindADome : public ::testing::TestWithParam<Setup> {};

// A thick dome whose centre is 40 % of its inner radius away from the lens. There are no reference
// values for domes. The limit is a tenth of the limit for flat ports, which refract more strongly,
// and twice the measured error.
TEST_P(WarpBehindADome, IsBetterStill) {
  const DomePort<double> port{{0.012, -0.008, 0.014}, 0.05, 0.02, 1, 1.52, 1.333};
  const DomePortCamera<double> camera(lens_with_fov(80, kSize, kSize), port, kSize, kSize);
  const Errors errors = patch_errors(camera, GetParam());
  report("patch error of the first-order exact warp behind a dome [px]", errors.affine);
  EXPECT_LE(errors.affine, 0.0005);
}

INSTANTIATE_TEST_SUITE_P(Setups, WarpBehindADome,
                         ::testing::Values(Setup{kBaseline, 0}, Setup{kBaseline, -40},
                                           Setup{kFurther, 0}));

// Compares A with finite differences of the exact warp between two views of the same kind.
template <class View>
bool check_slope_of_warp(const View& one, const View& other, Random& random) {
  const auto reference = one.template camera<double>(), source = other.template camera<double>();
  const Matrix3<double> R = Eigen::AngleAxisd(0.2, random.unit_vector()).toRotationMatrix();
  const Vector3<double> C = 0.3 * random.unit_vector();
  const Vector2<double> p = random_pixel(random, one);
  const Vector3<double> n = -Vector3<double>::UnitZ() + 0.5 * random.unit_vector();
  const AxialRay<double> ray = reference.ray(p);
  const double lambda = random.uniform(1, 4);
  const AffineWarp<double> warp = affine_warp(reference, source, R, C, p, lambda, n);
  if (!warp.visible) return false;
  const double h = 1e-2;
  for (int i = 0; i < 2; ++i) {
    const auto image = [&](double step) {
      const AxialRay<double> r =
          reference.ray(Vector2<double>(p + step * Vector2<double>::Unit(i)));
      return source.project(R * (r.at(plane_intersection(r, ray.at(lambda), n)) - C)).pixel;
    };
    // Pixels have an error of 1e-12 of the image's width; the step is a hundredth of a pixel.
    EXPECT_LT((warp.linear.col(i) - (image(h) - image(-h)) / (2 * h)).norm(),
              1e-6 * warp.linear.norm());
  }
  return true;
}

TEST(AffineWarp, IsTheSlopeOfTheExactWarp) {
  Random random(102);
  int flat = 0, dome = 0;  // warps that the source sees
  for (int k = 0; k < 500; ++k) {
    flat += check_slope_of_warp(random_view(random), random_view(random), random);
    dome +=
        check_slope_of_warp(random_dome_view(random, 0.8), random_dome_view(random, 0.8), random);
  }
  EXPECT_GT(std::min(flat, dome), 250);
}

template <class View>
View any_view(Random& random) {
  if constexpr (std::is_same_v<View, DomeView>)
    return random_dome_view(random, 0.8);
  else
    return random_view(random);
}

template <class View>
class PlanePointDerivative : public ::testing::Test {};
using Views = ::testing::Types<View, DomeView>;
TYPED_TEST_SUITE(PlanePointDerivative, Views);

// Compares dX/dp with differences between the points that neighbouring pixels see.
TYPED_TEST(PlanePointDerivative, IsTheDerivative) {
  Random random(101);
  for (int k = 0; k < 1000; ++k) {
    const TypeParam view = any_view<TypeParam>(random);
    const auto camera = view.template camera<double>();
    const Vector2<double> p = random_pixel(random, view);
    const Vector3<double> n = (-Vector3<double>::UnitZ() + 0.5 * random.unit_vector());
    AxialRayJacobian<double> jacobian;
    const AxialRay<double> ray = camera.ray(p, jacobian);
    const double lambda = random.log_uniform(0.5, 10);
    const Vector3<double> X = ray.at(lambda);
    const Matrix32<double> dX = plane_point_derivative(ray, jacobian, lambda, n);
    EXPECT_LT((n.transpose() * dX).norm(), 1e-14);
    const double h = 1e-3;
    for (int i = 0; i < 2; ++i) {
      const auto point = [&](double step) {
        const AxialRay<double> other =
            camera.ray(Vector2<double>(p + step * Vector2<double>::Unit(i)));
        return Vector3<double>(other.at(plane_intersection(other, X, n)));
      };
      EXPECT_LT((dX.col(i) - (point(h) - point(-h)) / (2 * h)).norm(), 1e-6 * dX.norm());
    }
  }
}

}  // namespace
}  // namespace axial::refractive::testing
