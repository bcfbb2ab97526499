// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/log.h"
#include "base/naming.h"
#include "control/target_places.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLeastTargets = 3;

// Sets `file` if it is not stated. Returns whether there is one.
bool find_places(const fs::path& mesh, const char* option, bool must, fs::path& file) {
  if (file.empty()) file = control::places_beside(mesh, option);
  if (file.empty() && must)
    fail_in(mesh, "no {} in its folder or in refined/ there; {} states the file",
            control::kTargetPlaces, option);
  return !file.empty();
}

// Places and their covariance of the targets with these indices.
void take(const control::TargetPlaces& all, const std::vector<std::size_t>& indices,
          Eigen::Matrix3Xd& places, Eigen::MatrixXd& covariance) {
  const auto count = static_cast<Eigen::Index>(indices.size());
  places.resize(3, count);
  covariance.resize(3 * count, 3 * count);
  const auto row = [&](Eigen::Index i) {
    return 3 * static_cast<Eigen::Index>(indices[static_cast<std::size_t>(i)]);
  };
  for (Eigen::Index i = 0; i < count; ++i) {
    places.col(i) = all.targets[indices[static_cast<std::size_t>(i)]].world;
    for (Eigen::Index j = 0; j < count; ++j)
      covariance.block<3, 3>(3 * i, 3 * j) = all.covariance.block<3, 3>(row(i), row(j));
  }
}

compare::CommonTargets common_of(const control::TargetPlaces& before,
                                 const control::TargetPlaces& after) {
  compare::CommonTargets common;
  std::vector<std::size_t> first, second;
  for (const auto& [earlier, later] : control::common_targets(before, after)) {
    common.labels.push_back(before.targets[earlier].label);
    first.push_back(earlier);
    second.push_back(later);
  }
  take(before, first, common.before, common.covariance_before);
  take(after, second, common.after, common.covariance_after);
  return common;
}

std::string named(const std::vector<std::string>& labels, const std::vector<std::size_t>& which) {
  std::string text;
  for (const std::size_t i : which) text += (text.empty() ? "" : ", ") + labels[i];
  return text;
}

void warn_of_moved(const ByTargets& by_targets) {
  const compare::TargetRegistration& found = by_targets.found;
  for (const std::size_t i : found.moved)
    log_warning("{} moved by {:.1f} mm between the surveys, and is left out", by_targets.labels[i],
                1e3 * found.residuals.col(static_cast<Eigen::Index>(i)).norm());
  if (!found.doubtful.empty())
    log_warning("a target moved between the surveys: one of {}, which do not show which one",
                named(by_targets.labels, found.doubtful));
  if (!found.agrees)
    log_warning(
        "the targets of both surveys agree worse than their standard deviations allow: the sum of "
        "squares is {:.1f} where {} is expected; the standard deviations of the registration are "
        "enlarged",
        found.chi_squared, found.freedom);
}

void warn_of_scale(const compare::TargetRegistration& found) {
  constexpr double kDoubtful = 3;  // standard deviations
  const double off = found.scale - 1;
  if (std::abs(off) > kDoubtful * found.scale_sigma)
    log_warning(
        "the scales of the surveys differ: between the targets, lengths of the earlier survey are "
        "{:.3f} +- {:.3f} % {} than those of the later one",
        100 * std::abs(off), 100 * found.scale_sigma, off > 0 ? "larger" : "smaller");
}

}  // namespace

std::optional<ByTargets> register_by_targets(Settings& settings) {
  const bool must = settings.align == Align::targets;
  if (!must && settings.align != Align::automatic) return {};
  const bool has_before = find_places(settings.before, "--targets", must, settings.targets_before);
  const bool has_after =
      find_places(settings.after, "--other-targets", must, settings.targets_after);
  if (!has_before || !has_after) {
    log_info("--align auto: by the ground, because a survey has no places of targets");
    return {};
  }
  const compare::CommonTargets common =
      common_of(control::read_target_places(settings.targets_before),
                control::read_target_places(settings.targets_after));
  if (!must && common.labels.size() < kLeastTargets) {
    log_info("--align auto: by the ground, because {} targets are in both surveys",
             common.labels.size());
    return {};
  }
  return ByTargets{
      naming(settings.targets_after, [&] { return compare::register_targets(common); }),
      common.labels};
}

void move_later(const ByTargets& by_targets, const LocalFrame& later, const LocalFrame& earlier,
                Mesh& mesh, std::vector<geometry::PosedCamera>& photos, Eigen::Vector3d& facing) {
  Similarity motion = by_targets.found.motion;  // between the frames
  motion.translation += motion.rotation * later.origin - earlier.origin;
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = motion(vertex.cast<double>()).cast<float>();
  for (geometry::PosedCamera& photo : photos) photo.pose = motion(photo.pose);
  facing = motion.rotation * facing;
}

void report(const ByTargets& by_targets) {
  const compare::TargetRegistration& found = by_targets.found;
  log_info(
      "{} of {} common targets used: sum of squares {:.1f} (expected {}), scale of the earlier "
      "survey {:.6f} +- {:.6f} times that of the later one",
      found.used.size(), by_targets.labels.size(), found.chi_squared, found.freedom, found.scale,
      found.scale_sigma);
  for (const std::size_t i : found.used) {
    const Eigen::Vector3d off = 1e3 * found.residuals.col(static_cast<Eigen::Index>(i));
    log_info("  {}: later minus earlier place ({:+.2f}, {:+.2f}, {:+.2f}) mm", by_targets.labels[i],
             off.x(), off.y(), off.z());
  }
  warn_of_moved(by_targets);
  warn_of_scale(found);
}

}  // namespace axial::apps
