// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/advice.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "calibrate/board_pose.h"
#include "calibrate/information.h"
#include "io/cameras/housing.h"
#include "pose/adjust/free_numbers.h"

namespace axial::calibrate {
namespace {

std::vector<Eigen::Vector3d> corners_of(const pose::Bundle& bundle) {
  std::vector<Eigen::Vector3d> corners;
  for (const pose::BundlePoint& point : bundle.points) corners.push_back(point.position);
  return corners;
}

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The limit in the value's unit. The focal length has none: it stays as calibrated in air.
double limit_of(const pose::HousingNumber& value, const Limits& limits) {
  switch (value.quantity) {
    case pose::Quantity::angle:
      return limits.normal * value.scale;
    case pose::Quantity::distance:
    case pose::Quantity::coordinate:
      return limits.place * value.scale;
    case pose::Quantity::index:
      return limits.index * value.scale;
    case pose::Quantity::thickness:
      return limits.thickness * value.scale;
    default:
      return kInfinite;
  }
}

struct Worst {
  pose::HousingNumber value;
  double ratio = 0;  // standard deviation divided by its limit
};

Worst worst_of(const pose::HousingChange<double>& sigmas, const Calibration& calibration,
               const Limits& limits) {
  Worst worst;
  for (const pose::HousingNumber& value :
       pose::free_values(calibration.bundle.bundle, {&sigmas, 1}, calibration.adjust)) {
    const double ratio = value.sigma / limit_of(value, limits);
    if (!(ratio <= worst.ratio)) worst = {value, std::isnan(ratio) ? kInfinite : ratio};
  }
  return worst;
}

// The bundle with the port as calibrated. If the calibrated values are not valid for a port, the
// bundle with the port before calibration, and board poses for it.
pose::ColmapBundle believable(const Calibration& calibration) {
  const pose::HousedCamera now = calibration.camera().now();
  try {
    io::check_port(*now.port, "port");
    return calibration.bundle;
  } catch (const Error&) {
    std::vector<Pose> poses;
    for (const pose::BundleImage& image : calibration.bundle.bundle.images)
      poses.push_back(image.pose);
    pose::ColmapBundle before =
        board_bundle(calibration.bundle.lenses[0], *calibration.camera().measured.port,
                     calibration.views, corners_of(calibration.bundle.bundle), poses);
    place_boards(before.bundle);
    return before;
  }
}

double nearest(const pose::Bundle& bundle, const std::vector<View>& views) {
  double least = kInfinite;
  for (std::size_t i = 0; i < bundle.images.size(); ++i)
    least = std::min(least, board_place(bundle, i, views[i]).distance);
  return least;
}

Eigen::Vector3d middle_of(const pose::Bundle& bundle) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const pose::BundlePoint& point : bundle.points) sum += point.position;
  return sum / static_cast<double>(bundle.points.size());
}

Eigen::Vector3d middle_of_piece(const pose::Bundle& bundle, const View& view) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Corner& corner : view.corners) sum += bundle.points[corner.number].position;
  return sum / static_cast<double>(view.corners.size());
}

void add_edges(const Calibration& calibration, std::vector<std::string>& missing) {
  const io::ColmapCamera& lens = calibration.bundle.lenses[0];
  const auto width = static_cast<double>(lens.width), height = static_cast<double>(lens.height);
  double left = width, right = width, upper = height, lower = height;  // free margins
  for (const pose::Observation& observation : calibration.bundle.bundle.observations) {
    const Eigen::Vector2d& at =
        calibration.views[observation.image].corners[observation.source].pixel;
    left = std::min(left, at.x());
    right = std::min(right, width - 1 - at.x());
    upper = std::min(upper, at.y());
    lower = std::min(lower, height - 1 - at.y());
  }
  constexpr double kNear = 0.15;
  const auto check = [&](double margin, double size, const char* edge) {
    if (margin > kNear * size)
      missing.push_back(fmt::format("corners near the image's {} edge", edge));
  };
  check(left, width, "left");
  check(right, width, "right");
  check(upper, height, "upper");
  check(lower, height, "lower");
}

}  // namespace

BoardPlace board_place(const pose::Bundle& bundle, std::size_t image, const View& view) {
  const Eigen::Vector3d middle = view.piece ? middle_of_piece(bundle, view) : middle_of(bundle);
  const Pose& pose = bundle.images[image].pose;
  const double cosine = std::min(1.0, std::abs(pose.rotation(2, 2)));
  return {pose.to_camera(middle).norm(), std::acos(cosine) * 180 / std::numbers::pi};
}

std::vector<std::string> gaps(const Calibration& calibration) {
  std::vector<std::string> missing;
  add_edges(calibration, missing);
  const pose::Bundle& bundle = calibration.bundle.bundle;
  double steepest = 0, near = kInfinite, far = 0;
  for (std::size_t i = 0; i < bundle.images.size(); ++i) {
    const BoardPlace place = board_place(bundle, i, calibration.views[i]);
    steepest = std::max(steepest, place.tilt_degrees);
    near = std::min(near, place.distance);
    far = std::max(far, place.distance);
  }
  constexpr double kSteepEnough = 20, kFarEnough = 1.3;
  if (steepest < kSteepEnough)
    missing.push_back(fmt::format("a board tilted by {} degrees or more", kSteepEnough));
  if (far < kFarEnough * near)
    missing.push_back(fmt::format("a distance other than {:.2f} m", near));
  return missing;
}

std::optional<NextPhotograph> next_photograph(const Calibration& calibration,
                                              const Limits& limits) {
  const pose::ColmapBundle bundle = believable(calibration);
  const std::vector<Eigen::Vector3d> corners = corners_of(bundle.bundle);
  constexpr double kNoLess = 0.1;  // [px]: few photographs may fit better than corners are detected
  const double noise = std::max(kNoLess, calibration.uncertainty.pixel_sigma);
  const Information known = total_information(bundle.bundle, calibration.adjust, noise);
  const auto boards =
      placed_boards(bundle, corners, 0.8 * nearest(bundle.bundle, calibration.views));
  std::vector<View> views;
  std::vector<Pose> poses;
  for (const PlacedBoard& board : boards) {
    views.push_back({"", board.corners});
    poses.push_back(board.pose);
  }
  const pose::ColmapBundle added =
      board_bundle(bundle.lenses[0], *bundle.bundle.cameras[0].now().port, views, corners, poses);
  std::optional<NextPhotograph> best;
  double least = kInfinite;
  for (std::size_t i = 0; i < boards.size(); ++i) {
    const Information with = known + information(added.bundle, i) / (noise * noise);
    const auto sigmas = sigmas_from(with, calibration.adjust);
    const double ratio = worst_of(sigmas, calibration, limits).ratio;
    if (ratio < least) least = ratio, best = NextPhotograph{boards[i], sigmas};
  }
  return best;
}

void require_known(const Calibration& calibration, const Limits& limits) {
  const auto& sigmas = calibration.uncertainty.camera_sigmas[0];
  const Worst worst = worst_of(sigmas, calibration, limits);
  if (worst.ratio <= 1) return;
  const pose::HousingNumber& value = worst.value;
  std::string said = fmt::format(
      "{} photographs determine the {} to +- {:.2g} {} only, allowed is +- {:.2g}",
      calibration.views.size(), value.name, value.sigma, value.unit, limit_of(value, limits));
  if (const auto missing = gaps(calibration); !missing.empty())
    said += fmt::format("; no photograph shows {}", fmt::join(missing, ", nor "));
  if (const auto next = next_photograph(calibration, limits))
    said += fmt::format("; the most useful next photograph shows {} (then +- {:.2g})",
                        words_for(next->board),
                        next->sigmas(static_cast<Eigen::Index>(value.number)) * value.scale);
  throw Error(said);
}

}  // namespace axial::calibrate
