// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the flat port with an oracle that uses neither Snell's law nor any formula of
// refractive/. By Fermat's principle light takes the path of the smallest optical length. The path
// from the lens to X bends at a point of the inner plane and at a point of the outer plane. The
// oracle searches both points by brute force.
#include <gtest/gtest.h>

#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

// The optical length is flat at its minimum, so that the position of the minimum has only half of
// the digits. The 64 bits of the mantissa give about 1e-9 m, and hence about 1e-6 px.
using Real = long double;

// Argument of the minimum of a convex function on [low, high], by golden-section search.
template <class Function>
Real golden_section(Real low, Real high, Function f) {
  const Real k = (std::sqrt(Real(5)) - 1) / 2;
  Real a = high - k * (high - low);
  Real b = low + k * (high - low);
  Real fa = f(a);
  Real fb = f(b);
  for (int step = 0; step < 52; ++step) {
    if (fa < fb) {
      high = b;
      b = a;
      fb = fa;
      a = high - k * (high - low);
      fa = f(a);
    } else {
      low = a;
      a = b;
      fa = fb;
      b = low + k * (high - low);
      fb = f(b);
    }
  }
  return (low + high) / 2;
}

struct Path {
  double inner, outer;  // distances of the two bends from the axis
};

// sqrt(h^2 + r^2) - h. Subtracting h does not move the minimum, and fewer digits are lost.
Real excess(Real h, Real r) {
  const Real length = std::sqrt(h * h + r * r);
  return length > 0 ? r * r / (length + h) : 0;
}

// The shortest path in the plane through the axis and X. `rho`: distance of X from the axis. `z`:
// its height above the outer plane. The inner bend lies between the axis and the outer bend, and
// the outer bend between the inner bend and X.
Path shortest_path(const FlatPort<double>& port, double rho, double z) {
  const auto length = [&](Real inner, Real outer) {
    return port.n_air * excess(port.distance, inner) +
           port.n_glass * excess(port.thickness, outer - inner) +
           port.n_water * excess(z, rho - outer);
  };
  const auto best_outer = [&](Real inner) {
    return golden_section(inner, rho, [&](Real outer) { return length(inner, outer); });
  };
  const Real inner = golden_section(
      0, rho, [&](Real candidate) { return length(candidate, best_outer(candidate)); });
  return {static_cast<double>(inner), static_cast<double>(best_outer(inner))};
}

struct Image {
  Vector2<double> pixel;
  Vector3<double> exit;
};

Image image_by_fermat(const View& view, const Vector3<double>& X) {
  const FlatPort<double>& port = view.port;
  const double outer = port.distance + port.thickness;
  const Vector3<double> across = X - X.dot(port.normal) * port.normal;
  const Vector3<double> e = across.normalized();
  const Path path = shortest_path(port, across.norm(), X.dot(port.normal) - outer);
  return {view.lens.pixel(port.distance * port.normal + path.inner * e),
          outer * port.normal + path.outer * e};
}

View random_fermat_view(Random& random) {
  View view = random_view(random, 640, 480);
  view.port.distance = random.log_uniform(0.01, 0.1);
  view.port.thickness = random.uniform(0.002, 0.02);
  return view;
}

TEST(Fermat, AgreesWithForwardProjection) {
  Random random(31);
  double largest = 0;
  int tested = 0;
  for (int k = 0; k < 200; ++k) {
    const View view = random_fermat_view(random);
    const auto camera = view.camera<double>();
    // The point is made by pinhole geometry, so that the test uses no ray of refractive/.
    const Vector3<double> X =
        view.lens.bearing(random_pixel(random, view)) * random.uniform(0.3, 3);
    const Projection<double> image = camera.project(X);
    if (!image.visible) continue;
    largest = std::max(largest, (image.pixel - image_by_fermat(view, X).pixel).norm());
    ++tested;
  }
  report("Fermat against forward projection, largest [px]", largest);
  EXPECT_LT(largest, 1e-5);
  EXPECT_GT(tested, 100);  // refraction moves some points out of the image
}

TEST(Fermat, AgreesWithBackProjection) {
  Random random(32);
  double largest = 0;
  for (int k = 0; k < 200; ++k) {
    const View view = random_fermat_view(random);
    const auto camera = view.camera<double>();
    const Vector2<double> pixel = random_pixel(random, view);
    const Vector3<double> exit = camera.exit_point(pixel);
    const AxialRay<double> ray = camera.ray(pixel);
    const Vector3<double> X = exit + random.uniform(0.3, 3) * ray.direction;
    const Image image = image_by_fermat(view, X);
    largest = std::max(largest, (image.pixel - pixel).norm());
    EXPECT_LT((image.exit - exit).norm(), 1e-8);
  }
  report("Fermat against back-projection, largest [px]", largest);
  EXPECT_LT(largest, 1e-5);
}

// Tests the oracle: moving a bend in any direction on its plane makes the path longer.
TEST(Fermat, ThePathIsAMinimumInSpace) {
  Random random(33);
  for (int k = 0; k < 20; ++k) {
    const View view = random_fermat_view(random);
    const FlatPort<double>& port = view.port;
    const double outer = port.distance + port.thickness;
    const Vector3<double> X = view.lens.bearing(random_pixel(random, view)) * 1.5;
    const Vector3<double> across = X - X.dot(port.normal) * port.normal;
    const Path path = shortest_path(port, across.norm(), X.dot(port.normal) - outer);
    const Vector3<double> e = across.normalized();
    const Vector3<double> inner_bend = port.distance * port.normal + path.inner * e;
    const Vector3<double> outer_bend = outer * port.normal + path.outer * e;
    const auto length = [&](const Vector3<double>& a, const Vector3<double>& b) {
      return port.n_air * a.norm() + port.n_glass * (b - a).norm() + port.n_water * (X - b).norm();
    };
    for (int i = 0; i < 20; ++i) {
      const Vector3<double> da = random.unit_vector().cross(port.normal) * 1e-4;
      const Vector3<double> db = random.unit_vector().cross(port.normal) * 1e-4;
      EXPECT_GT(length(inner_bend + da, outer_bend + db), length(inner_bend, outer_bend));
    }
  }
}

}  // namespace
}  // namespace axial::refractive::testing
