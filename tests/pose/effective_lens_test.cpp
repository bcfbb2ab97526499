// SPDX-License-Identifier: GPL-3.0-or-later
// The lens that a pinhole engine needs behind a port, against the exact projection.
#include "pose/effective_lens.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "pose/adjust/adjust.h"
#include "pose/survey.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using testing::dome_port;
using testing::flat_port;
using testing::housed;

// The RMS error [px] of the lens as the camera of the best pose for points at one depth: the error
// that a pinhole engine has to live with. Found by bundle adjustment of a pinhole's pose, which
// shares nothing with the fit.
double error_in_adjustment(const EffectiveLens& found, const HousedCamera& camera, double depth) {
  const PhotographCamera exact(camera);
  Bundle bundle;
  bundle.cameras.push_back({{found.lens, {}}});
  bundle.images.push_back({"photograph", 0, Pose{}});
  for (int i = -9; i <= 9; ++i)
    for (int k = -7; k <= 7; ++k) {
      const Eigen::Vector3d point(0.06 * i * depth, 0.06 * k * depth, depth * (1 + 0.02 * (i + k)));
      const PhotographImage seen = exact.image(point);
      if (!seen.visible) continue;
      bundle.observations.push_back({0, bundle.points.size(), seen.pixel, bundle.points.size()});
      bundle.points.push_back({point, bundle.points.size()});
    }
  AdjustOptions options;
  options.points_known = true;
  adjust(bundle, options);
  return root_mean_square(reprojection_errors(bundle));
}

struct Behind {
  refractive::Port<double> port;
  double rms, largest;  // at most [px]
};

// Behind a tilted port, the picture is stretched to one side, which the model OPENCV describes only
// to first order.
TEST(EffectiveLens, ImagesAsTheLensBehindItsPort) {
  for (const auto& [port, rms, largest] :
       {Behind{flat_port(0, 0.05), 0.3, 1.5}, Behind{flat_port(3, 0.02), 1.2, 6},
        Behind{dome_port(), 0.3, 1.5}}) {
    const HousedCamera camera = housed(camera_behind(port));
    const EffectiveLens found = effective_lens(camera, 2);
    EXPECT_LT(found.rms, rms);
    EXPECT_LT(found.largest, largest);
    EXPECT_LT(error_in_adjustment(found, camera, 2), 2 * rms);
  }
}

TEST(EffectiveLens, OfACloseFlatPortHasItsFocalLengthTimesTheIndex) {
  const HousedCamera camera = housed(camera_behind(flat_port(0, 0.005)));
  for (const double distance : {1.0, 4.0}) {
    const EffectiveLens found = effective_lens(camera, distance);
    EXPECT_NEAR(found.lens.pinhole.fx / camera.lens.pinhole.fx, 1.333, 0.01) << distance;
    EXPECT_LT(found.rms, 0.5);
  }
}

TEST(EffectiveLens, OfAPinholeInAirIsThePinhole) {
  const HousedCamera camera = housed(camera_behind({}));
  const EffectiveLens found = effective_lens(camera, 2);
  EXPECT_EQ(found.lens.model->name, "OPENCV");
  EXPECT_NEAR(found.lens.pinhole.fx, camera.lens.pinhole.fx, 1e-3);
  EXPECT_LT(found.rms, 1e-3);
}

TEST(EffectiveLens, RefusesWrongDistances) {
  const HousedCamera camera = housed(camera_behind(flat_port()));
  EXPECT_THROW(effective_lens(camera, 0), Error);
  EXPECT_THROW(effective_lens(camera, std::nan("")), Error);
}

}  // namespace
}  // namespace axial::pose
