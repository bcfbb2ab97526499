// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/colmap_bundle.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pose/adjust/adjust.h"
#include "pose/adjust/uncertainty.h"
#include "pose/colmap_survey.h"
#include "support/error_of.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using testing::flat_port;
using testing::housing;
using testing::kLens;
using testing::model_of;
using testing::survey;

TEST(ColmapBundle, SeesThroughLensAndPort) {
  const io::ColmapModel model = model_of(survey(camera_behind(flat_port(2)), {}));
  const ColmapBundle bundle = to_bundle(model, {&kLens, 1}, housing());
  EXPECT_EQ(bundle.unseen, 0u);
  ASSERT_EQ(bundle.bundle.cameras.size(), 1u);
  for (const double error : reprojection_errors(bundle.bundle)) ASSERT_LT(error, 1e-6);
}

// An error of a tenth of a pixel in the photograph counts as a tenth, wherever the lens distorts.
TEST(ColmapBundle, MeasuresErrorsInThePhotograph) {
  io::ColmapModel model = model_of(survey(camera_behind(flat_port(2)), {}));
  for (io::ColmapImage& image : model.images)
    for (io::ColmapPoint2D& point : image.points) point.x += 0.1;
  const ColmapBundle bundle = to_bundle(model, {&kLens, 1}, housing());
  for (const double error : reprojection_errors(bundle.bundle)) ASSERT_NEAR(error, 0.1, 1e-9);
}

// The focal length is far too short, and its factor corrects it exactly. The image of the
// distortion grows with the focal length: a distortion that stays as it is would cause errors of
// pixels.
TEST(ColmapBundle, DistortionFollowsTheFocalLength) {
  const io::ColmapModel model = model_of(survey(camera_behind(flat_port(2)), {}));
  for (const double factor : {1.01, 1.3}) {
    io::ColmapCamera lens = kLens;
    lens.params[0] /= factor;
    lens.params[1] /= factor;
    ColmapBundle bundle = to_bundle(model, {&lens, 1}, housing());
    bundle.bundle.cameras[0].change(kFocalNumber) = std::log(factor);
    for (const double error : reprojection_errors(bundle.bundle)) ASSERT_LT(error, 1e-6) << factor;
  }
}

// One adjustment finds the focal length of a lens with distortion.
TEST(ColmapBundle, FindsTheFocalLength) {
  const io::ColmapModel model = model_of(survey(camera_behind(flat_port(2)), {}));
  io::ColmapCamera lens = kLens;
  lens.params[0] /= 1.05;
  lens.params[1] /= 1.05;
  ColmapBundle bundle = to_bundle(model, {&lens, 1}, housing());
  AdjustOptions options;
  options.poses_known = true;
  options.free[kFocalNumber] = true;
  adjust(bundle.bundle, options);
  EXPECT_NEAR(bundle.bundle.cameras[0].change(kFocalNumber), std::log(1.05), 1e-9);
  for (const double error : reprojection_errors(bundle.bundle)) ASSERT_LT(error, 1e-6);
}

// This lens folds back where its image ends, 0.6 focal lengths from the principal point.
TEST(ColmapBundle, CountsObservationsForWhichTheLensHasNoDirection) {
  io::ColmapModel model = model_of(survey(camera_behind(flat_port(2)), {}));
  const io::ColmapCamera folding{4, "RADIAL", 1024, 768, {620, 512, 384, -0.5, 0.1}};
  const auto is_beyond = [](const io::ColmapPoint2D& point) {
    return std::hypot(point.x - 512, point.y - 384) > 0.6 * 620;
  };
  std::size_t beyond = 0, all = 0;
  for (const io::ColmapImage& image : model.images) {
    beyond += static_cast<std::size_t>(std::ranges::count_if(image.points, is_beyond));
    all += image.points.size();
  }
  ASSERT_GT(beyond, 0u);
  const ColmapBundle bundle = to_bundle(model, {&folding, 1}, housing());
  EXPECT_EQ(bundle.unseen, beyond);
  EXPECT_EQ(bundle.bundle.observations.size(), all - beyond);
}

TEST(ColmapBundle, BecomesTheModelAgain) {
  const io::ColmapModel model = model_of(survey(camera_behind(flat_port(2)), {.noise = 0.5}));
  ColmapBundle bundle = to_bundle(model, {&kLens, 1}, housing());
  bundle.bundle.cameras[0].change(kFocalNumber) = std::log(1.01);
  bundle.bundle.images[2].pose.centre.x() += 0.1;
  const io::ColmapModel back = to_model(bundle, model);
  ASSERT_EQ(back.cameras.size(), 1u);
  EXPECT_EQ(back.cameras[0].model, "OPENCV");
  EXPECT_NEAR(back.cameras[0].params[0], 620 * 1.01, 1e-9);
  EXPECT_NEAR(back.cameras[0].params[1], 615 * 1.01, 1e-9);
  EXPECT_EQ(back.cameras[0].params[2], 512);
  EXPECT_EQ(back.images[2].pose.centre.x(), model.images[2].pose.centre.x() + 0.1);
  ASSERT_EQ(back.points.size(), model.points.size());
  for (std::size_t i = 0; i < back.points.size(); ++i) {
    EXPECT_EQ(back.points[i].id, model.points[i].id);
    EXPECT_EQ(back.points[i].track.size(), model.points[i].track.size());
  }
  for (std::size_t i = 0; i < back.images.size(); ++i) {
    ASSERT_EQ(back.images[i].points.size(), model.images[i].points.size());
    for (std::size_t k = 0; k < back.images[i].points.size(); ++k) {
      EXPECT_EQ(back.images[i].points[k].x, model.images[i].points[k].x);
      EXPECT_EQ(back.images[i].points[k].point3d, model.images[i].points[k].point3d);
    }
  }
}

TEST(ColmapBundle, LeavesOutWhatWasDropped) {
  const io::ColmapModel model = model_of(survey(camera_behind(flat_port(2)), {}));
  ColmapBundle bundle = to_bundle(model, {&kLens, 1}, housing());
  const Observation dropped = bundle.bundle.observations[0];
  bundle.bundle.observations.erase(bundle.bundle.observations.begin());
  const io::ColmapModel back = to_model(bundle, model);
  EXPECT_EQ(back.images[dropped.image].points[dropped.source].point3d, io::kNoPoint3D);
  EXPECT_EQ(back.points[0].track.size() + 1, model.points[0].track.size());
}

TEST(ColmapBundle, GivesEachPortItsCamera) {
  const io::ColmapModel model = model_of(survey(camera_behind(flat_port(2)), {}));
  io::Housing two = housing();
  two.ports["other"] = flat_port(0);
  two.images["image3.jpg"] = "other";
  two.images["image4.jpg"] = "none";
  ColmapBundle bundle = to_bundle(model, {&kLens, 1}, two);
  ASSERT_EQ(bundle.ports, (std::vector<std::string>{"main", "other", "none"}));
  EXPECT_FALSE(bundle.bundle.cameras[2].measured.port);
  bundle.bundle.cameras[1].change(2) = 0.003;
  const io::Housing back = to_housing(bundle, two);
  const io::ColmapModel refined = to_model(bundle, model);
  EXPECT_EQ(back.port_of("image0.jpg", refined.images[0].camera), "main");
  EXPECT_EQ(back.port_of("image3.jpg", refined.images[3].camera), "other");
  EXPECT_EQ(back.port_of("image4.jpg", refined.images[4].camera), "none");
  EXPECT_NEAR(std::get<refractive::FlatPort<double>>(back.ports.at("other")).distance, 0.023,
              1e-15);
}

// Half of the photographs are reduced copies: lens and port are one, whatever the size.
TEST(ColmapBundle, CamerasOfTwoSizesShareWhatIsMeasured) {
  const Bundle truth = survey(camera_behind(flat_port(2)), {.noise = 0.3});
  io::ColmapModel model = model_of(truth);
  model.cameras.push_back(model.cameras[0]);
  io::ColmapCamera& small = model.cameras[1];
  small.id = 5;
  small.width = 512;
  small.height = 384;
  io::ColmapCamera small_lens = kLens;
  small_lens.id = 5;
  small_lens.width = 512;
  small_lens.height = 384;
  for (const int k : {0, 1, 2, 3}) small_lens.params[static_cast<std::size_t>(k)] /= 2;
  for (std::size_t i = 0; i < model.images.size(); i += 2) {
    model.images[i].camera = 5;
    for (io::ColmapPoint2D& point : model.images[i].points) {
      point.x /= 2;
      point.y /= 2;
    }
  }
  ColmapBundle bundle = to_bundle(model, std::vector{kLens, small_lens}, housing());
  ASSERT_EQ(bundle.bundle.cameras.size(), 2u);
  EXPECT_EQ(bundle.bundle.cameras[1].same_as, 0u);
  AdjustOptions options;
  options.free = {true, true, true, true, false, true};
  options.default_sigma = {0.05, 0.05, 0.005, 0.004, 0, 0.005};
  options.poses_known = true;
  adjust(bundle.bundle, options);
  EXPECT_EQ(bundle.bundle.cameras[0].change, bundle.bundle.cameras[1].change);
  EXPECT_FALSE(bundle.bundle.cameras[0].change.isZero(0));
  const Uncertainty known = uncertainty(bundle.bundle, options);
  EXPECT_EQ(known.camera_sigmas[0], known.camera_sigmas[1]);
  EXPECT_GT(known.camera_sigmas[0](kIndexNumber), 0);
  EXPECT_EQ(covariance_of_numbers(bundle.bundle, options).numbers.size(), 5u);
  const io::Housing back = to_housing(bundle, housing());
  EXPECT_EQ(back.ports.size(), 1u);
  EXPECT_EQ(back.default_port, "main");
}

// A zoomed lens has another entrance pupil: it gets numbers of its own.
TEST(ColmapBundle, CamerasOfTwoFocalLengthsShareNothing) {
  io::ColmapModel model = model_of(survey(camera_behind(flat_port(2)), {}));
  model.cameras.push_back(model.cameras[0]);
  model.cameras[1].id = 5;
  model.images[0].camera = 5;
  io::ColmapCamera zoomed = kLens;
  zoomed.id = 5;
  zoomed.params[0] *= 1.2;
  zoomed.params[1] *= 1.2;
  const ColmapBundle bundle = to_bundle(model, std::vector{kLens, zoomed}, housing());
  ASSERT_EQ(bundle.bundle.cameras.size(), 2u);
  EXPECT_FALSE(bundle.bundle.cameras[1].same_as);
}

TEST(ColmapBundle, RefusesAWaterSurface) {
  const io::ColmapModel model = model_of(survey(camera_behind(flat_port(2)), {}));
  io::Housing lake = housing();
  lake.ports["main"] = WaterSurface{};
  EXPECT_EQ(test::error_of([&] {
              to_bundle(model, {&kLens, 1}, lake);
            }),
            "port 'main' is a water surface, which is a different port for every pose");
}

TEST(ColmapBundle, RefusesALensOfAnotherSizeOrNone) {
  const io::ColmapModel model = model_of(survey(camera_behind(flat_port(2)), {}));
  io::ColmapCamera small = kLens;
  small.width = 512;
  EXPECT_EQ(test::error_of([&] {
              to_bundle(model, {&small, 1}, housing());
            }),
            "camera 4 is 1024 x 768, but its lens calibrated in air is 512 x 768");
  std::vector<io::ColmapCamera> others{kLens, kLens};
  others[0].id = 1;
  others[1].id = 2;
  EXPECT_EQ(test::error_of([&] { to_bundle(model, others, housing()); }),
            "camera 4 has no lens calibrated in air");
}

// A model as COLMAP-Underwater writes it. Its camera has the port, whether the poses were computed
// with the port or in air, as far as a focal length compensates for the port.
io::ColmapModel solved_with(const io::Housing& housing) {
  const io::ColmapModel tracks =
      model_of(survey(camera_behind(flat_port(2)), {.points = 100, .noise = 0.2}));
  ColmapBundle bundle = to_bundle(tracks, {&kLens, 1}, housing);
  AdjustOptions options;
  options.free[kFocalNumber] = housing.ports.empty();
  adjust(bundle.bundle, options);  // the initial focal length is a third too short
  io::ColmapModel model = to_model(bundle, tracks);
  model.cameras[0].port = flat_port(2);
  return model;
}

TEST(PortFit, TellsPosesSolvedWithThePortFromPosesSolvedInAir) {
  const PortFit refractive = port_fit(solved_with(housing()));
  EXPECT_LT(refractive.behind_ports, 0.2 * std::sqrt(2));  // not more than the noise of both axes
  EXPECT_GT(refractive.in_air, 10 * refractive.behind_ports);
  io::ColmapModel absorbed = solved_with({});
  const PortFit in_air = port_fit(absorbed);
  EXPECT_GT(in_air.behind_ports, 10 * in_air.in_air);
  absorbed.points.clear();
  const PortFit nothing = port_fit(absorbed);
  EXPECT_EQ(nothing.behind_ports, 0);
  EXPECT_EQ(nothing.in_air, 0);
}

}  // namespace
}  // namespace axial::pose
