// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/rig_survey.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <random>

#include "drawn.h"

namespace axial::pose::testing {
namespace {

// The pose of the left camera at a time [s]: it looks down, and sways.
Pose left_at(const RigSurveyOptions& options, double time) {
  const double half = options.interval * (options.frames - 1) / 2;
  const double sway = options.sway;
  const Eigen::Vector3d centre(options.speed * (time - half), 0.02 * sway * std::sin(1.3 * time),
                               0.05 * sway * std::sin(0.9 * time));
  const Eigen::Vector3d target(centre.x() + 0.05 * sway * std::sin(1.1 * time), 0.1,
                               options.distance);
  return looking_at(centre, target, 0.1 * sway * std::sin(0.7 * time));
}

Pose right_at(const RigSurveyOptions& options, double time) {
  const Pose left = left_at(options, time), in_rig = right_in_rig(options);
  return {in_rig.rotation * left.rotation, left.to_world(in_rig.centre)};
}

void add_images(Bundle& bundle, const RigSurveyOptions& options) {
  for (int i = 0; i < options.frames; ++i) {
    const double time = options.interval * i;
    bundle.images.push_back({fmt::format("left/frame{:02}.jpg", i), 0, left_at(options, time)});
    bundle.images.push_back(
        {fmt::format("right/frame{:02}.jpg", i), 1, right_at(options, time + options.delay)});
  }
}

}  // namespace

Pose right_in_rig(const RigSurveyOptions& options) {
  return {Eigen::AngleAxisd(options.turn * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix(),
          options.base};
}

Bundle rig_survey(const RigSurveyOptions& options) {
  const std::array models{camera_behind(flat_port(2)), camera_behind(flat_port(-1, 0.03))};
  Bundle bundle;
  for (const CameraModel& model : models)
    bundle.cameras.push_back({housed(model), HousingChange<double>::Zero()});
  add_images(bundle, options);
  const std::array seeing{make_camera<double>(models[0]), make_camera<double>(models[1])};
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> noise(0, options.noise > 0 ? options.noise : 1e-9);
  const double half = options.speed * options.interval * (options.frames - 1) / 2 + 0.5;
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  while (bundle.points.size() < static_cast<std::size_t>(options.points)) {
    const double z = options.distance * uniform(0.8, 1.2), y = uniform(-0.5, 0.7);
    const Eigen::Vector3d point(uniform(-half, half), y, z);
    std::vector<Observation> track;
    for (std::size_t i = 0; i < bundle.images.size(); ++i) {
      const BundleImage& image = bundle.images[i];
      const auto seen = std::visit(
          [&](const auto& camera) { return camera.project(image.pose.to_camera(point)); },
          seeing[image.camera]);
      const Eigen::Vector2d& p = seen.pixel;
      if (!seen.visible || p.minCoeff() < 0 || p.x() > 1023 || p.y() > 767) continue;
      Observation observation;
      observation.image = i;
      observation.point = observation.source = bundle.points.size();
      observation.pixel = p + axial::test::drawn<2>(noise, random);
      track.push_back(observation);
    }
    if (track.size() < 3) continue;
    bundle.observations.insert(bundle.observations.end(), track.begin(), track.end());
    bundle.points.push_back({point, bundle.points.size()});
  }
  return bundle;
}

Rig true_rig(const RigSurveyOptions& options, RigCamera::Known known) {
  Rig rig;
  rig.cameras.resize(2);
  rig.cameras[0].name = "left/";
  rig.cameras[0].known = RigCamera::Known::fixed;
  rig.cameras[1].name = "right/";
  rig.cameras[1].known = known;
  if (known != RigCamera::Known::free)
    rig.cameras[1].stated = rig.cameras[1].now = right_in_rig(options);
  for (std::size_t i = 0; i < static_cast<std::size_t>(options.frames); ++i)
    rig.frames.push_back({{{0, 2 * i}, {1, 2 * i + 1}}, options.interval * static_cast<double>(i)});
  rig.has_seconds = true;
  return rig;
}

}  // namespace axial::pose::testing
