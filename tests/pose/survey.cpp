// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/survey.h"

#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "drawn.h"
#include "pose/adjust/adjust.h"
#include "pose/refine.h"
#include "scene/decompositions.h"

namespace axial::pose::testing {

Pose looking_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& target, double roll) {
  const Eigen::Vector3d z = (target - centre).normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Eigen::Matrix3d rotation;
  rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
  return {Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).toRotationMatrix() * rotation, centre};
}

Bundle survey(const CameraModel& camera, const SurveyOptions& options) {
  std::mt19937_64 random(options.seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::normal_distribution<double> noise(0, 1);
  const double d = options.distance;
  Bundle bundle;
  bundle.cameras.push_back({housed(camera), HousingChange<double>::Zero()});
  for (int i = 0; i < options.images; ++i) {
    const double along = 0.9 * d * (i / (options.images - 1.0) - 0.5);
    // A line for each number: C++ leaves the order of arguments open.
    const double up = uniform(-0.2, 0.2) * d;
    const Eigen::Vector3d centre(along, uniform(-0.25, 0.25) * d, up);
    const double beside = uniform(-0.2, 0.2) * d;
    const Eigen::Vector3d target(uniform(-0.3, 0.3) * d, beside, d);
    bundle.images.push_back(
        {"image" + std::to_string(i) + ".jpg", 0, looking_at(centre, target, i * 1.3)});
  }
  const auto seeing = make_camera<double>(camera);
  while (bundle.points.size() < static_cast<std::size_t>(options.points)) {
    const double z = uniform(0.8, 1.25) * d, y = uniform(-0.6, 0.6) * d;
    const Eigen::Vector3d point(uniform(-0.8, 0.8) * d, y, z);
    std::vector<Observation> track;
    for (std::size_t i = 0; i < bundle.images.size(); ++i) {
      const auto image = std::visit(
          [&](const auto& c) { return c.project(bundle.images[i].pose.to_camera(point)); }, seeing);
      const Eigen::Vector2d& p = image.pixel;
      if (!image.visible || p.x() < 0 || p.y() < 0 || p.x() > camera.width - 1 ||
          p.y() > camera.height - 1)
        continue;
      Observation observation;
      observation.image = i;
      observation.point = bundle.points.size();
      observation.pixel = p + options.noise * axial::test::drawn<2>(noise, random);
      observation.source = bundle.points.size();
      track.push_back(observation);
    }
    if (track.size() < 3) continue;
    bundle.observations.insert(bundle.observations.end(), track.begin(), track.end());
    bundle.points.push_back({point, bundle.points.size()});
  }
  return bundle;
}

Bundle mixed_survey(const CameraModel& first, const CameraModel& second,
                    const SurveyOptions& options) {
  Bundle bundle = survey(first, options);
  bundle.cameras.push_back({housed(second), HousingChange<double>::Zero()});
  const auto seeing = make_camera<double>(second);
  std::mt19937_64 random(options.seed + 1);
  std::normal_distribution<double> noise(0, 1);
  for (std::size_t i = 1; i < bundle.images.size(); i += 2) bundle.images[i].camera = 1;
  std::erase_if(bundle.observations, [&](Observation& observation) {
    const BundleImage& image = bundle.images[observation.image];
    if (image.camera == 0) return false;
    const Eigen::Vector3d X = image.pose.to_camera(bundle.points[observation.point].position);
    const auto seen = std::visit([&](const auto& c) { return c.project(X); }, seeing);
    observation.pixel = seen.pixel + options.noise * axial::test::drawn<2>(noise, random);
    const Eigen::Vector2d& p = seen.pixel;
    return !seen.visible || p.x() < 0 || p.y() < 0 || p.x() > second.width - 1 ||
           p.y() > second.height - 1;
  });
  return bundle;
}

Bundle absorbed(const Bundle& truth, double scale) {
  Bundle bundle = truth;
  for (BundleCamera& camera : bundle.cameras) camera.measured.port.reset();
  AdjustOptions options;
  options.free[kFocalNumber] = true;
  options.loss_sigmas = 10;
  adjust(bundle, options);
  scale_places(bundle, scale);
  bundle.cameras = truth.cameras;
  return bundle;
}

KnownDistance known_length(const Bundle& truth, double sigma) {
  const std::size_t last = truth.images.size() - 1;
  const double length = (truth.images[0].pose.centre - truth.images[last].pose.centre).norm();
  return {KnownDistance::Between::images, 0, last, length, sigma * length};
}

void disturb(Bundle& bundle, double angle, double shift, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  const auto vector = [&] { return axial::test::drawn<3>(normal, random); };
  for (BundleImage& image : bundle.images) {
    const Eigen::Vector3d turn = angle * vector();
    image.pose.rotation =
        Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * image.pose.rotation;
    image.pose.centre += shift * vector();
  }
  for (BundlePoint& point : bundle.points) point.position += shift * vector();
}

PoseErrors pose_errors(const Bundle& found, const Bundle& truth, bool with_scale) {
  const auto count = static_cast<Eigen::Index>(found.images.size());
  Eigen::Matrix3Xd from(3, count), to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.col(i) = found.images[static_cast<std::size_t>(i)].pose.centre;
    to.col(i) = truth.images[static_cast<std::size_t>(i)].pose.centre;
  }
  const Similarity fit = best_similarity(from, to, with_scale);
  PoseErrors errors;
  errors.scale = fit.scale;
  double sum = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    sum += (fit(Eigen::Vector3d(from.col(i))) - to.col(i)).squaredNorm();
    const Eigen::Matrix3d between =
        found.images[static_cast<std::size_t>(i)].pose.rotation * fit.rotation.transpose() *
        truth.images[static_cast<std::size_t>(i)].pose.rotation.transpose();
    errors.largest_angle =
        std::max(errors.largest_angle, Eigen::AngleAxisd(between).angle() / kDegree);
  }
  errors.centre_rms = std::sqrt(sum / static_cast<double>(count));
  return errors;
}

}  // namespace axial::pose::testing
