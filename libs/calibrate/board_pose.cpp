// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/board_pose.h"

#include <opencv2/calib3d.hpp>
#include <optional>

#include "base/error.h"
#include "pose/adjust/adjust.h"
#include "scene/decompositions.h"

namespace axial::calibrate {
namespace {

// The corners of one image: on the board, and their rays in water as intersections with z = 1.
struct Perspective {
  std::vector<cv::Point3d> board;
  std::vector<cv::Point2d> directions;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // mean origin of the rays
};

Perspective perspective_of(const pose::Bundle& image) {
  Perspective result;
  const pose::PhotographCamera camera(image.cameras[0].now());
  for (const pose::Observation& observation : image.observations) {
    const auto ray = camera.ray(observation.pixel);
    if (!(ray.direction.z() > 0)) continue;  // also for NaN
    const Eigen::Vector3d& corner = image.points[observation.point].position;
    result.board.emplace_back(corner.x(), corner.y(), corner.z());
    result.directions.emplace_back(ray.direction.x() / ray.direction.z(),
                                   ray.direction.y() / ray.direction.z());
    result.centre += ray.origin;
  }
  if (!result.board.empty()) result.centre /= static_cast<double>(result.board.size());
  return result;
}

// Corners on one line leave the rotation about that line open.
bool spans_a_plane(const std::vector<cv::Point3d>& board) {
  constexpr std::size_t kLeast = 4;
  if (board.size() < kLeast) return false;
  Eigen::Matrix3Xd places(3, board.size());
  for (std::size_t i = 0; i < board.size(); ++i)
    places.col(static_cast<Eigen::Index>(i)) = Eigen::Vector3d(board[i].x, board[i].y, board[i].z);
  return relative_width(places) > kLineWidth;
}

Pose pose_of(const cv::Mat& turn, const cv::Mat& place, const Eigen::Vector3d& centre) {
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  Pose pose;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) pose.rotation(i, j) = rotation(i, j);
  const Eigen::Vector3d from_camera =
      centre + Eigen::Vector3d(place.at<double>(0), place.at<double>(1), place.at<double>(2));
  pose.centre = -pose.rotation.transpose() * from_camera;
  return pose;
}

// Up to two poses that explain the rays as a perspective image of the board.
std::vector<Pose> likely_poses(const Perspective& seen) {
  std::vector<Pose> poses;
  if (!spans_a_plane(seen.board)) return poses;
  std::vector<cv::Mat> turns, places;
  try {
    cv::solvePnPGeneric(seen.board, seen.directions, cv::Matx33d::eye(), cv::noArray(), turns,
                        places, false, cv::SOLVEPNP_IPPE);
  } catch (const cv::Exception&) {  // for example if all corners coincide
    return poses;
  }
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Pose pose = pose_of(turns[i], places[i], seen.centre);
    if (pose.rotation.allFinite() && pose.centre.allFinite()) poses.push_back(pose);
  }
  return poses;
}

struct Placed {
  Pose pose;
  double cost = 0;
};

// The result of adjusting `image` from `pose`; empty if the adjustment fails.
std::optional<Placed> placed_from(const Pose& pose, pose::Bundle& image) {
  pose::AdjustOptions options;
  options.points_known = true;
  options.loss_sigmas = 8;  // errors caused by a wrong port do not mark outliers
  image.images[0].pose = pose;
  try {
    const double cost = adjust(image, options).final_cost;
    return Placed{image.images[0].pose, cost};
  } catch (const Error&) {
    return {};
  }
}

pose::Bundle only(const pose::Bundle& bundle, std::size_t image) {
  pose::Bundle one{bundle.cameras, {bundle.images[image]}, bundle.points, {}};
  for (const pose::Observation& observation : bundle.observations) {
    if (observation.image != image) continue;
    one.observations.push_back(observation);
    one.observations.back().image = 0;
  }
  return one;
}

// Of the likely poses the one with the least errors in pixels, which is a better measure than
// errors of directions.
std::optional<Placed> best_place(const pose::Bundle& bundle, std::size_t image) {
  pose::Bundle one = only(bundle, image);
  std::optional<Placed> best;
  for (const Pose& pose : likely_poses(perspective_of(one)))
    if (const auto placed = placed_from(pose, one); placed && (!best || placed->cost < best->cost))
      best = placed;
  return best;
}

}  // namespace

void place_boards(pose::Bundle& bundle) {
  std::vector<bool> known(bundle.images.size());
  for (std::size_t i = 0; i < bundle.images.size(); ++i) {
    const auto best = best_place(bundle, i);
    known[i] = best.has_value();
    if (best) bundle.images[i].pose = best->pose;
  }
  std::erase_if(bundle.observations,
                [&](const pose::Observation& observation) { return !known[observation.image]; });
}

}  // namespace axial::calibrate
