// SPDX-License-Identifier: GPL-3.0-or-later
// Properties that every kind of axial camera must have.
#include <gtest/gtest.h>

#include "refractive/affine_warp.h"
#include "refractive/dome_views.h"
#include "refractive/lens_camera.h"
#include "refractive/line_search.h"
#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

struct Dry {
  using Camera = PinholeCamera<double>;
  static constexpr double kPixels = 1e-9;
  static Camera make(const View& view, Random&) { return Camera(view.lens); }
};
struct DryFloat {
  using Camera = PinholeCamera<float>;
  static constexpr double kPixels = 2e-3;
  static Camera make(const View& view, Random&) { return Camera(view.lens.cast<float>()); }
};
struct Port {
  using Camera = FlatPortCamera<double>;
  static constexpr double kPixels = 1e-9;
  static Camera make(const View& view, Random&) { return view.camera<double>(); }
};
struct PortFloat {
  using Camera = FlatPortCamera<float>;
  static constexpr double kPixels = 2e-3;
  static Camera make(const View& view, Random&) { return view.camera<float>(); }
};
struct Search {
  using Camera = LineSearchCamera<double>;
  static constexpr double kPixels = 1.1;
  static Camera make(const View& view, Random&) {
    return Camera(view.lens, view.port, view.width, view.height);
  }
};
struct SearchFloat {
  using Camera = LineSearchCamera<float>;
  static constexpr double kPixels = 1.1;
  static Camera make(const View& view, Random&) {
    return Camera(view.lens.cast<float>(), view.port.cast<float>(), view.width, view.height);
  }
};
// The lens of `view` with a small amount of every kind of distortion.
template <class T>
DistortedLens<T> distorted(const View& view) {
  LensDistortion<double> distortion;
  distortion.above[1] = -0.02;
  distortion.below[0] = 0.05;
  distortion.p1 = 1e-3;
  distortion.prism = {0, -1e-3};
  return {view.lens, distortion, view.width, view.height};
}
struct Lens {
  using Camera = LensFlatPortCamera<double>;
  static constexpr double kPixels = 1e-9;
  static Camera make(const View& view, Random&) { return {distorted<double>(view), view.port}; }
};
struct LensFloat {
  using Camera = LensFlatPortCamera<float>;
  static constexpr double kPixels = 2e-3;
  static Camera make(const View& view, Random&) {
    return {distorted<float>(view), view.port.cast<float>()};
  }
};
// A thick dome that replaces the flat port. Its centre is up to 0.8 of its inner radius away from
// the lens.
DomePort<double> thick_dome(Random& random) {
  DomePort<double> port = random_dome_view(random, 0.8).port;
  port.thickness = random.uniform(0.01, 0.02);
  return port;
}
struct Dome {
  using Camera = DomePortCamera<double>;
  static constexpr double kPixels = 1e-9;
  static Camera make(const View& view, Random& random) {
    return {view.lens, thick_dome(random), view.width, view.height};
  }
};
struct DomeFloat {
  using Camera = DomePortCamera<float>;
  static constexpr double kPixels = 2e-3;
  static Camera make(const View& view, Random& random) {
    return {view.lens.cast<float>(), thick_dome(random).cast<float>(), view.width, view.height};
  }
};
struct LensDome {
  using Camera = LensDomePortCamera<double>;
  static constexpr double kPixels = 1e-9;
  static Camera make(const View& view, Random& random) {
    return {distorted<double>(view), thick_dome(random)};
  }
};

template <class Kind>
class Cameras : public ::testing::Test {};
using Kinds = ::testing::Types<Dry, DryFloat, Port, PortFloat, Search, SearchFloat, Lens, LensFloat,
                               Dome, DomeFloat, LensDome>;
TYPED_TEST_SUITE(Cameras, Kinds);

// Calls check(camera, pixel, distance) with random pixels inside the image and distances of 0.7 to
// 10 m, at which all points lie in the water.
template <class Kind, class Check>
void for_random_points(unsigned seed, Check check) {
  using T = typename Kind::Camera::Scalar;
  Random random(seed);
  for (int k = 0; k < 10; ++k) {
    View view = random_view(random, 160, 120);
    view.port.distance = std::min(view.port.distance, 0.03);
    const typename Kind::Camera camera = Kind::make(view, random);
    for (int i = 0; i < 100; ++i) {
      const Vector2<T> pixel(static_cast<T>(random.uniform(2, 157)),
                             static_cast<T>(random.uniform(2, 117)));
      check(camera, pixel, static_cast<T>(random.log_uniform(0.7, 10)));
    }
  }
}

TYPED_TEST(Cameras, RaysStartNearTheCentreAndHaveUnitLength) {
  for_random_points<TypeParam>(91, [](const auto& camera, const auto& pixel, auto) {
    const auto ray = camera.ray(pixel);
    EXPECT_NEAR(ray.direction.norm(), 1, 1e-6);
    EXPECT_LT(ray.origin.norm(), 0.2);
    EXPECT_GT(ray.direction.z(), 0);
  });
}

TYPED_TEST(Cameras, ProjectWhatTheyBackProject) {
  for_random_points<TypeParam>(92, [](const auto& camera, const auto& pixel, auto distance) {
    const auto image = camera.project(camera.ray(pixel).at(distance));
    EXPECT_TRUE(image.visible);
    EXPECT_LT((image.pixel - pixel).norm(), TypeParam::kPixels);
  });
}

TYPED_TEST(Cameras, CopiesAreTheSameCamera) {
  for_random_points<TypeParam>(93, [](const auto& camera, const auto& pixel, auto distance) {
    const auto copy = camera;
    const auto X = camera.ray(pixel).at(distance);
    EXPECT_EQ(copy.project(X).pixel, camera.project(X).pixel);
  });
}

// On any plane Jproj dX/dp = I. This checks the derivatives of both directions against each other.
TYPED_TEST(Cameras, WarpedOntoThemselvesAreTheIdentity) {
  using T = typename TypeParam::Camera::Scalar;
  Random random(94);
  for_random_points<TypeParam>(94, [&](const auto& camera, const auto& pixel, auto distance) {
    const Vector3<T> n =
        (-Vector3<double>::UnitZ() + 0.7 * random.unit_vector()).normalized().template cast<T>();
    // A plane that is nearly parallel to the ray has no warp.
    if (std::abs(camera.ray(pixel).direction.dot(n)) < T(0.2)) return;
    const auto warp = affine_warp(camera, camera, Matrix3<T>(Matrix3<T>::Identity()),
                                  Vector3<T>(Vector3<T>::Zero()), pixel, distance, n);
    EXPECT_TRUE(warp.visible);
    EXPECT_LT((warp.to - pixel).norm(), TypeParam::kPixels);
    // Rounding of products of numbers of the order of f: 1e-16 or 1e-7 times about a hundred.
    EXPECT_LT((warp.linear - Matrix2<T>::Identity()).norm(),
              (std::is_same_v<T, float> ? 1e-4 : 1e-11));
  });
}

}  // namespace
}  // namespace axial::refractive::testing
