// SPDX-License-Identifier: GPL-3.0-or-later
#include "refractive/polynomial_projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

// The polynomial's root is not refined by iterations, so that reference and projection share no
// code of the solver.
TEST(PolynomialProjection, AgreesWithTheExactProjection) {
  Random random(51);
  std::vector<double> errors;
  for (int k = 0; k < 4000; ++k) {
    const View view = random_view(random);
    const auto camera = view.camera<double>();
    const auto X = random_point(random, camera, random_pixel(random, view));
    if (!X) continue;
    const Projection<double> image = project_by_polynomial(camera, *X);
    ASSERT_TRUE(image.visible);
    errors.push_back((image.pixel - camera.project(*X).pixel).norm());
  }
  ASSERT_GT(errors.size(), 3500u);
  std::ranges::sort(errors);
  report("polynomial against exact projection, median [px]", errors[errors.size() / 2]);
  report("polynomial against exact projection, 99th percentile [px]",
         errors[errors.size() * 99 / 100]);
  EXPECT_LT(errors[errors.size() / 2], 1e-8);
  EXPECT_LT(errors[errors.size() * 99 / 100], 2e-4);
}

TEST(PolynomialProjection, KnowsPortsWithoutGlassAndWithoutGap) {
  Random random(52);
  for (int k = 0; k < 1000; ++k) {
    View view = random_view(random);
    view.port.distance = std::min(view.port.distance, 0.03);
    (k % 2 ? view.port.thickness : view.port.distance) = 0;
    const auto camera = view.camera<double>();
    const auto X = random_point(random, camera, random_pixel(random, view));
    if (!X) continue;
    const Projection<double> image = project_by_polynomial(camera, *X);
    ASSERT_TRUE(image.visible);
    // Same tolerance as the 99th percentile above.
    EXPECT_LT((image.pixel - camera.project(*X).pixel).norm(), 2e-4);
  }
}

TEST(PolynomialProjection, OnTheAxisAndBehindThePort) {
  const View view{640, 480, lens_with_fov(80, 640, 480), paper_port()};
  const auto camera = view.camera<double>();
  EXPECT_LT(
      (project_by_polynomial(camera, {0, 0, 2}).pixel - camera.project({0, 0, 2}).pixel).norm(),
      1e-12);
  EXPECT_FALSE(project_by_polynomial(camera, {0.1, 0, 0.03}).visible);
  EXPECT_FALSE(project_by_polynomial(camera, {0.1, NAN, 1}).visible);
}

TEST(PolynomialProjection, FindsNothingBeyondTotalReflection) {
  View view{640, 480, lens_with_fov(80, 640, 480), paper_port()};
  view.port.distance = 0;
  const FlatPortOptics<double> optics(view.port);
  for (const double z : {0.1, 1.0, 10.0}) {
    const double bound =
        view.port.thickness / std::sqrt(optics.glass.c) + z / std::sqrt(optics.water.c);
    EXPECT_TRUE(tangent_by_polynomial(optics, 0.9 * bound, z));
    EXPECT_FALSE(tangent_by_polynomial(optics, 1.1 * bound, z));
  }
}

}  // namespace
}  // namespace axial::refractive::testing
