// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/rig_fit.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/order_statistics.h"

namespace axial::pose {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Neighbouring frames that are farther apart than this times the median say nothing about the
// velocity.
constexpr double kFarApart = 2.5;
// A wrong port shifts a camera by less than this, and looks like a short delay [m].
constexpr double kLeastShift = 0.0005;

// The index into Bundle::images of the photograph of a camera in a frame.
std::optional<std::size_t> image_of(const RigFrame& frame, std::size_t camera) {
  const auto found = std::ranges::find(frame.images, camera, &RigFrame::Image::camera);
  if (found == frame.images.end()) return {};
  return found->image;
}

// The poses of a camera in its rig, one for each frame that has it and the reference camera.
std::vector<Pose> poses_in_rig(const Bundle& bundle, const Rig& rig, std::size_t camera) {
  std::vector<Pose> poses;
  for (const RigFrame& frame : rig.frames) {
    const auto reference = image_of(frame, 0), image = image_of(frame, camera);
    if (reference && image)
      poses.push_back(relative_pose(bundle.images[*image].pose, bundle.images[*reference].pose));
  }
  return poses;
}

double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a * b.transpose()).angle();
}

// The pose whose sum of distances from all others is smallest. Rotations count with the length of
// the median translation, and at most kMost poses are compared.
Pose central_pose(std::vector<Pose> poses) {
  constexpr std::size_t kMost = 200;
  if (poses.size() > kMost) {
    std::vector<Pose> some;
    for (std::size_t i = 0; i < kMost; ++i) some.push_back(poses[i * poses.size() / kMost]);
    poses = std::move(some);
  }
  std::vector<double> lengths;
  for (const Pose& pose : poses) lengths.push_back(pose.centre.norm());
  const double length = mean_median(lengths);
  std::size_t best = 0;
  double least = kInfinity;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    double sum = 0;
    for (const Pose& other : poses)
      sum += (other.centre - poses[i].centre).norm() +
             length * angle_between(other.rotation, poses[i].rotation);
    if (sum < least) least = sum, best = i;
  }
  return poses[best];
}

// The deviation of a frame from the present pose of a camera.
struct FrameFit {
  std::size_t frame;             // index into Rig::frames
  double translation, rotation;  // [m], [rad]

  double in_sigmas() const {
    return std::hypot(translation / kFrameTranslation, rotation / kFrameRotation);
  }
};

// Counts the frames, and separates those that are wrong.
void take_frames(const std::vector<FrameFit>& frames, RigFit& fit) {
  constexpr double kWrong = 12, kTimesMedian = 5;
  std::vector<double> all;
  for (const FrameFit& frame : frames) all.push_back(frame.in_sigmas());
  const double most = std::max(kWrong, kTimesMedian * mean_median(all));
  double translation = 0, rotation = 0;
  for (const FrameFit& frame : frames) {
    if (frame.in_sigmas() > most) {
      fit.wrong.push_back(frame.frame);
      continue;
    }
    translation += frame.translation * frame.translation;
    rotation += frame.rotation * frame.rotation;
  }
  fit.frames = frames.size();
  const auto right =
      static_cast<double>(std::max<std::size_t>(1, frames.size() - fit.wrong.size()));
  fit.translation_rms = std::sqrt(translation / right);
  fit.rotation_rms = std::sqrt(rotation / right);
}

// Deviations of a camera from its stated pose in its rig, with the velocities of the rig.
struct Deviations {
  std::vector<Eigen::Vector3d> deviations, velocities;
};

// The information about the constant deviation: none along the base.
Eigen::Matrix3d information_about_constant(const RigCamera& camera) {
  if (!camera.is_metric()) return Eigen::Matrix3d::Zero();
  const double sigma =
      camera.known == RigCamera::Known::fixed ? kStatedTranslation : camera.sigma_translation;
  Eigen::Matrix3d across = Eigen::Matrix3d::Identity();
  if (camera.stated.centre.norm() > 0) {
    const Eigen::Vector3d base = camera.stated.centre.normalized();
    across -= base * base.transpose();
  }
  return across / (sigma * sigma);
}

// The residuals of `found` with the constant and the delay `x`.
std::vector<double> residuals(const Deviations& found, const Eigen::Vector4d& x) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < found.deviations.size(); ++i)
    lengths.push_back((found.deviations[i] - x.head<3>() - x(3) * found.velocities[i]).norm());
  return lengths;
}

// The delay and its standard deviation, by iterated weights of a Huber loss.
std::pair<double, double> delay_of(const Deviations& found, const RigCamera& camera) {
  constexpr int kIterations = 20;
  constexpr std::size_t kFewest = 4;
  if (found.deviations.size() < kFewest) return {0, kInfinity};
  Eigen::Vector4d x = Eigen::Vector4d::Zero();
  Eigen::Matrix4d normal;
  for (int i = 0; i < kIterations; ++i) {
    const std::vector<double> lengths = residuals(found, x);
    // The median length of a vector of three normal numbers is 1.54 standard deviations.
    const double sigma = std::max(1e-5, mean_median(lengths) / 1.54);
    normal.setZero();
    normal.topLeftCorner<3, 3>() = information_about_constant(camera);
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (std::size_t k = 0; k < lengths.size(); ++k) {
      Eigen::Matrix<double, 3, 4> by_x;
      by_x << Eigen::Matrix3d::Identity(), found.velocities[k];
      const double weight =
          std::min(1.0, 2 * sigma / std::max(lengths[k], 1e-12)) / (sigma * sigma);
      normal += weight * by_x.transpose() * by_x;
      right += weight * by_x.transpose() * found.deviations[k];
    }
    const Eigen::FullPivLU<Eigen::Matrix4d> factor(normal);
    if (!factor.isInvertible()) return {0, kInfinity};
    x = factor.solve(right);
  }
  const Eigen::Matrix4d covariance = normal.inverse();
  return {x(3), std::sqrt(std::max(0.0, covariance(3, 3)))};
}

}  // namespace

Pose relative_pose(const Pose& image, const Pose& reference) {
  return {image.rotation * reference.rotation.transpose(), reference.to_camera(image.centre)};
}

double scale_by_rigs(const Bundle& bundle) {
  std::vector<double> ratios;
  for (const Rig& rig : bundle.rigs)
    for (const RigFrame& frame : rig.frames)
      for (std::size_t i = 0; i < frame.images.size(); ++i)
        for (std::size_t j = i + 1; j < frame.images.size(); ++j) {
          const RigFrame::Image &a = frame.images[i], &b = frame.images[j];
          const RigCamera &one = rig.cameras[a.camera], &two = rig.cameras[b.camera];
          if (!one.is_metric() || !two.is_metric()) continue;
          const double stated = (one.stated.centre - two.stated.centre).norm();
          const double found =
              (bundle.images[a.image].pose.centre - bundle.images[b.image].pose.centre).norm();
          if (stated > 0 && found > 0) ratios.push_back(stated / found);
        }
  return ratios.empty() ? 0 : mean_median(ratios);
}

void leave_out_unobserved(Bundle& bundle) {
  if (bundle.rigs.empty()) return;
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  for (Rig& rig : bundle.rigs)
    for (RigFrame& frame : rig.frames)
      std::erase_if(frame.images,
                    [&](const RigFrame::Image& image) { return counts[image.image] == 0; });
}

void start_rigs(Bundle& bundle) {
  for (Rig& rig : bundle.rigs)
    for (std::size_t camera = 0; camera < rig.cameras.size(); ++camera) {
      RigCamera& one = rig.cameras[camera];
      one.delay = 0;
      if (one.is_metric()) one.now = one.stated;
      if (one.is_metric()) continue;
      const std::vector<Pose> poses = poses_in_rig(bundle, rig, camera);
      if (!poses.empty()) one.now = central_pose(poses);
    }
}

std::vector<std::optional<Eigen::Vector3d>> rig_velocities(const Bundle& bundle, const Rig& rig) {
  std::vector<std::optional<Eigen::Vector3d>> velocities(rig.frames.size());
  std::vector<std::size_t> frames;  // with a photograph of the reference camera
  for (std::size_t i = 0; i < rig.frames.size(); ++i)
    if (image_of(rig.frames[i], 0)) frames.push_back(i);
  const auto gap = [&](std::size_t from, std::size_t to) {
    return rig.frames[frames[to]].time - rig.frames[frames[from]].time;
  };
  const auto pose_at = [&](std::size_t at) -> const Pose& {
    return bundle.images[*image_of(rig.frames[frames[at]], 0)].pose;
  };
  std::vector<double> gaps;
  for (std::size_t k = 1; k < frames.size(); ++k) gaps.push_back(gap(k - 1, k));
  const double most = kFarApart * mean_median(gaps);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::size_t before = k > 0 && gap(k - 1, k) <= most ? k - 1 : k;
    const std::size_t after = k + 1 < frames.size() && gap(k, k + 1) <= most ? k + 1 : k;
    if (gap(before, after) > 0)
      velocities[frames[k]] = pose_at(k).rotation *
                              (pose_at(after).centre - pose_at(before).centre) / gap(before, after);
  }
  return velocities;
}

bool RigFit::is_late() const {
  return std::isfinite(delay_sigma) && std::abs(delay) > 3 * delay_sigma &&
         std::abs(delay) * speed > kLeastShift;
}

RigFit fit_of(const Bundle& bundle, const Rig& rig, std::size_t camera) {
  const RigCamera& one = rig.cameras[camera];
  const auto velocities = rig_velocities(bundle, rig);
  RigFit fit;
  Deviations found;
  std::vector<double> speeds;
  std::vector<FrameFit> frames;
  for (std::size_t i = 0; i < rig.frames.size(); ++i) {
    const auto reference = image_of(rig.frames[i], 0), image = image_of(rig.frames[i], camera);
    if (!reference || !image) continue;
    const Pose pose = relative_pose(bundle.images[*image].pose, bundle.images[*reference].pose);
    const Eigen::Vector3d moved = one.delay * velocities[i].value_or(Eigen::Vector3d::Zero());
    frames.push_back({i, (pose.centre - one.now.centre - moved).norm(),
                      angle_between(pose.rotation, one.now.rotation)});
    if (!velocities[i]) continue;
    found.deviations.push_back(pose.centre - (one.is_metric() ? one.stated : one.now).centre);
    found.velocities.push_back(*velocities[i]);
    speeds.push_back(velocities[i]->norm());
  }
  take_frames(frames, fit);
  if (!speeds.empty()) fit.speed = mean_median(speeds);
  std::tie(fit.delay, fit.delay_sigma) = delay_of(found, one);
  return fit;
}

bool set_delays(Bundle& bundle) {
  constexpr double kSmall = 1.0 / 200;
  bool changed = false;
  for (Rig& rig : bundle.rigs)
    for (std::size_t camera = 1; camera < rig.cameras.size(); ++camera) {
      const RigFit fit = fit_of(bundle, rig, camera);
      double& delay = rig.cameras[camera].delay;
      const double before = std::exchange(delay, fit.is_late() ? fit.delay : 0);
      changed = changed || std::abs(delay - before) > kSmall * std::abs(delay);
    }
  return changed;
}

}  // namespace axial::pose
