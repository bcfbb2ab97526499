// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the fixed number of steps of single precision, but in double precision, so that rounding
// does not hide the error that the steps leave.
#include <gtest/gtest.h>

#include <cmath>

#include "refractive/flat_port_solver.h"

namespace axial::refractive {
namespace {

struct Case {
  double largest_tangent, distance, thickness, n_glass;
  double widened = 1;  // the field's tangent divided by the tangent `promised`
};

class FixedSteps : public testing::TestWithParam<Case> {};

// Tests tangents just below those at which the solver takes one more step, with 1 cm to 100 m of
// water. The largest tangent corresponds to 512 pixels. Terms that only the Jacobian uses are
// extrapolated to first order; an error of 1e-3 of such a term moves the corner of a matching
// window by less than 0.01 px.
TEST_P(FixedSteps, LeaveLessThanTheyPromise) {
  const Case& port = GetParam();
  FlatPort<double> measured;
  measured.distance = port.distance;
  measured.thickness = port.thickness;
  measured.n_glass = port.n_glass;
  measured.n_water = 1.34;
  const FlatPortOptics<double> optics(measured);
  const FlatPortField<double> field(optics, port.largest_tangent * port.widened,
                                    port.largest_tangent);
  for (const double z_water : {0.01, 0.1, 0.3, 1.0, 3.0, 100.0}) {
    for (int k = 1; k < 100; ++k) {
      const double rho = optics.radius(port.largest_tangent, z_water) * k / 100;
      const auto found = detail::solve_in_fixed_steps(optics, field, rho * rho, z_water);
      const auto exact = detail::solve_to_convergence(optics, field, rho * rho, z_water);
      EXPECT_NEAR(found.m * rho, exact.m * rho, 1e-4 / 512 * port.largest_tangent);
      EXPECT_NEAR(found.slope, exact.slope, 1e-4 * exact.slope);
      EXPECT_NEAR(found.inv_qw, exact.inv_qw, 1e-4 * exact.inv_qw);
      EXPECT_NEAR(found.spread, exact.spread, 1e-3 * exact.spread);
    }
    const double edge = 0.999 * field.radius(z_water);
    const auto found = detail::solve_in_fixed_steps(optics, field, edge * edge, z_water);
    const auto exact = detail::solve_to_convergence(optics, field, edge * edge, z_water);
    EXPECT_NEAR(found.m * edge, exact.m * edge, 1e-2 / 512 * port.largest_tangent);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Ports, FixedSteps,
    testing::Values(Case{1.149, 0.05, 0.01, 1.5}, Case{1.149, 0.01, 0.02, 1.5},
                    Case{1.149, 0.0, 0.005, 1.77}, Case{4.49, 0.05, 0.01, 1.5},
                    Case{6.99, 0.02, 0.02, 1.5}, Case{49.0, 0.05, 0.01, 1.5},
                    Case{0.5, 0.1, 0.0, 1.0},
                    // A water surface, seen from high above.
                    Case{1.149, 2.0, 0.0, 1.34}, Case{4.49, 50.0, 0.0, 1.34},
                    Case{49.0, 10.0, 0.0, 1.34},
                    // Fields widened by the default margin and more.
                    Case{1.149, 0.05, 0.01, 1.5, 1.25}, Case{1.149, 0.01, 0.02, 1.5, 1.3},
                    Case{1.149, 0.0, 0.005, 1.77, 1.3}, Case{4.49, 0.05, 0.01, 1.5, 1.3},
                    Case{6.99, 0.02, 0.02, 1.5, 1.3}, Case{0.5, 0.1, 0.0, 1.0, 1.5},
                    Case{1.149, 2.0, 0.0, 1.34, 1.25}, Case{4.49, 50.0, 0.0, 1.34, 1.3}));

// A margin, a tilt or an oblique view through a water surface can widen the field far beyond the
// image. The steps may be inaccurate there, but no such point may be projected into the image.
TEST(FixedStepsFarOutside, DoNotComeBack) {
  for (const double promised : {1.2, 2.0, 5.0, 13.9}) {
    for (const double distance : {0.0, 0.02, 0.0848, 3.0}) {
      for (const double thickness : {0.0, 0.01}) {
        FlatPort<double> port;
        port.distance = distance;
        port.thickness = thickness;
        port.n_glass = thickness > 0 ? 1.5 : 1.0;
        port.n_water = 1.3207;
        const FlatPortOptics<double> optics(port);
        const FlatPortField<double> field(optics, 50, promised);
        for (const double z_water : {0.01, 0.3, 1.0, 5.0767, 100.0}) {
          for (double t = promised; t < 50; t *= 1.01) {
            const double rho = optics.radius(t, z_water);
            const double found =
                detail::solve_in_fixed_steps(optics, field, rho * rho, z_water).m * rho;
            EXPECT_GT(found, 0.999 * promised)
                << promised << ' ' << distance << ' ' << thickness << ' ' << z_water << ' ' << t;
          }
        }
      }
    }
  }
}

// Tests a port without distance and thickness, at the smallest and the largest height that is
// visible in single precision: the products of the solver must stay within its range. The tolerance
// of 1e-3 is the rounding of rho, which grazing rays magnify a thousand times.
TEST(FixedStepsInSinglePrecision, StayWithinItsRange) {
  FlatPort<double> port;
  port.n_water = 2;
  const FlatPortOptics<double> optics(port);
  const FlatPortField<double> field(optics, 50, 50);
  const FlatPortOptics<float> optics_f(port.cast<float>());
  const FlatPortField<float> field_f(optics_f, 50.0f, 50.0f);
  for (const float z_water : {1.01e-4f, 0.99e5f}) {
    ASSERT_TRUE(field_f.contains(0.0f, z_water));
    for (int k = 0; k < 100; ++k) {
      const float rho = 0.01f * static_cast<float>(k) * field_f.radius(z_water);
      const auto found = detail::solve_in_fixed_steps(optics_f, field_f, rho * rho, z_water);
      const auto exact = detail::solve_to_convergence(optics, field, static_cast<double>(rho) * rho,
                                                      static_cast<double>(z_water));
      EXPECT_NEAR(found.m, exact.m, 1e-3 * exact.m);
      EXPECT_NEAR(found.slope, exact.slope, 1e-2 * exact.slope);
      EXPECT_NEAR(found.inv_qw, exact.inv_qw, 1e-3 * exact.inv_qw);
      EXPECT_TRUE(std::isfinite(found.spread));
    }
  }
}

}  // namespace
}  // namespace axial::refractive
