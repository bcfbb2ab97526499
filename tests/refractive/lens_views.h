// SPDX-License-Identifier: GPL-3.0-or-later
// Random lenses with distortion, without a port and behind the ports of views.h and dome_views.h.
#pragma once

#include "refractive/dome_views.h"
#include "refractive/lens_camera.h"
#include "refractive/views.h"

namespace axial::refractive::testing {

struct LensView {
  int width = 1024, height = 768;
  PinholeLens<double> lens{0, 0, 0, 0};
  LensDistortion<double> distortion;

  template <class T>
  DistortedLens<T> distorted() const {
    return {lens, distortion, width, height};
  }
  template <class T>
  LensPinholeCamera<T> camera() const {
    return LensPinholeCamera<T>(distorted<T>());
  }
};

template <template <class> class Camera, class Port>
struct LensPortView : LensView {
  Port port;

  template <class T>
  Camera<T> camera() const {
    return {distorted<T>(), port.template cast<T>()};
  }
};
using LensFlatView = LensPortView<LensFlatPortCamera, FlatPort<double>>;
using LensDomeView = LensPortView<LensDomePortCamera, DomePort<double>>;

// Whether every pixel of the image has a direction. Every lens that was calibrated from its own
// images satisfies this condition.
inline bool whole_image_defined(const LensView& view) {
  return view.distorted<double>().shows_all(view.width, view.height);
}

// Returns a random perspective lens with a field of view of 50 to 110 degrees and rational radial
// distortion, barrel or pincushion.
inline LensView perspective_lens(Random& random) {
  LensView view;
  view.lens = lens_with_fov(random.uniform(50, 110), view.width, view.height);
  auto& [fisheye, spread, above, below, p1, p2, prism] = view.distortion;
  above = {1, random.uniform(-0.3, 0.15), random.uniform(-0.02, 0.05), random.uniform(0, 0.01), 0};
  below = {random.uniform(0, 0.2), random.uniform(0, 0.05), 0};
  return view;
}

// Fisheye lenses whose image corners are 40 to 75 degrees from the axis.
inline LensView fisheye_lens(Random& random) {
  LensView view;
  view.lens = lens_with_fov(90, view.width, view.height);
  view.lens.fx = view.lens.fy = 640 / (random.uniform(40, 75) * kDegree);
  auto& [fisheye, spread, above, below, p1, p2, prism] = view.distortion;
  fisheye = 1;
  above = {1, random.uniform(-0.1, 0.1), random.uniform(-0.02, 0.03), random.uniform(-0.01, 0.01),
           random.uniform(0, 0.003)};
  return view;
}

// Returns a random lens of COLMAP's model FOV.
inline LensView field_of_view_lens(Random& random) {
  LensView view;
  view.lens = lens_with_fov(random.uniform(60, 110), view.width, view.height);
  const double omega = random.uniform(0.1, 1.2);
  view.distortion.fisheye = 1;
  view.distortion.spread = 2 * std::tan(omega / 2);
  view.distortion.above[0] = 1 / omega;
  return view;
}

// Returns a random lens of any of the kinds above, with a random principal point near the image's
// centre. Every pixel has a direction.
inline LensView random_lens(Random& random) {
  for (;;) {
    const double kind = random.uniform(0, 3);
    LensView view = kind < 1   ? perspective_lens(random)
                    : kind < 2 ? fisheye_lens(random)
                               : field_of_view_lens(random);
    view.lens.fy *= random.uniform(0.98, 1.02);
    view.lens.cx += random.uniform(-0.02, 0.02) * view.width;
    view.lens.cy += random.uniform(-0.02, 0.02) * view.height;
    view.distortion.p1 = random.uniform(-2e-3, 2e-3);
    view.distortion.p2 = random.uniform(-2e-3, 2e-3);
    view.distortion.prism = {random.uniform(-2e-3, 2e-3), random.uniform(-2e-3, 2e-3)};
    if (whole_image_defined(view)) return view;
  }
}

inline LensFlatView random_flat_lens(Random& random) {
  LensFlatView view{{random_lens(random)}, random_view(random).port};
  view.port.normal = tilted_normal(random.uniform(0, 5) * kDegree, random.uniform(0, 6));
  return view;
}

inline LensDomeView random_dome_lens(Random& random) {
  return {{random_lens(random)}, random_dome_view(random).port};
}

inline Vector2<double> random_pixel(Random& random, const LensView& view) {
  return {random.uniform(0, view.width - 1), random.uniform(0, view.height - 1)};
}

}  // namespace axial::refractive::testing
