// SPDX-License-Identifier: GPL-3.0-or-later
// An oracle that knows neither Snell's law nor any formula of refractive/: light takes the path of
// the smallest optical length. The path from the lens to X bends at a point of the inner plane and
// one of the outer plane; both are searched by brute force.
#include <gtest/gtest.h>

#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

// The least of an optical path is as flat as any minimum, so the points come out to the square root
// of the precision: 64 bits give about 1e-9 m, hence about 1e-6 px.
using Real = long double;

// Argument of the minimum of a convex function on [low, high], by golden sections.
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

// sqrt(h^2 + r^2) - h, which has the same minimum and loses fewer digits.
Real excess(Real h, Real r) {
  const Real length = std::sqrt(h * h + r * r);
  return length > 0 ? r * r / (length + h) : 0;
}

// In the plane through the axis and X; `rho` and `z` are X's distance from the axis and height
// above the outer plane. All bends lie between the axis and X, in order.
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
    // A point by pinhole geometry alone, so that no ray of refractive/ is involved.
    const Vector3<double> X =
        view.lens.bearing(random_pixel(random, view)) * random.uniform(0.3, 3);
    const Projection<double> image = camera.project(X);
    if (!image.visible) continue;
    largest = std::max(largest, (image.pixel - image_by_fermat(view, X).pixel).norm());
    ++tested;
  }
  report("Fermat against forward projection, largest [px]", largest);
  EXPECT_LT(largest, 1e-5);
  EXPECT_GT(tested, 100);  // refraction moves the others out of the image
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

// The oracle itself: moving a bend out of the plane of refraction, or along it, lengthens the path.
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
