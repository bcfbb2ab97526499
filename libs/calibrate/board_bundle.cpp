// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/board_bundle.h"

#include <Eigen/LU>
#include <opencv2/calib3d.hpp>

#include "base/error.h"
#include "io/colmap_lens.h"

namespace axial::calibrate {
namespace {

io::ColmapModel model_of(const io::ColmapCamera& lens, std::span<const View> views,
                         std::span<const Eigen::Vector3d> corners) {
  io::ColmapModel model;
  model.cameras = {lens};
  for (const Eigen::Vector3d& corner : corners)
    model.points.push_back({model.points.size(), corner, {}, 0, {}});
  for (const View& view : views) {
    io::ColmapImage image;
    image.id = static_cast<std::uint32_t>(model.images.size() + 1);
    image.camera = lens.id;
    image.name = view.image;
    for (const Corner& corner : view.corners) {
      model.points.at(corner.number)
          .track.push_back({image.id, static_cast<std::uint32_t>(image.points.size())});
      image.points.push_back({corner.pixel.x() + 0.5, corner.pixel.y() + 0.5, corner.number});
    }
    model.images.push_back(std::move(image));
  }
  return model;
}

// A view's corners on the board, and its rays in water by where they meet the plane z = 1.
struct Perspective {
  std::vector<cv::Point3d> board;
  std::vector<cv::Point2d> directions;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // where the rays come from, on average
};

Perspective perspective_of(const pose::Bundle& bundle, std::size_t image) {
  Perspective result;
  const auto camera = make_camera<double>(bundle.cameras[0].now());
  for (const pose::Observation& observation : bundle.observations) {
    if (observation.image != image) continue;
    const auto ray = std::visit([&](const auto& c) { return c.ray(observation.pixel); }, camera);
    if (!(ray.direction.z() > 0)) continue;
    const Eigen::Vector3d& corner = bundle.points[observation.point].position;
    result.board.emplace_back(corner.x(), corner.y(), corner.z());
    result.directions.emplace_back(ray.direction.x() / ray.direction.z(),
                                   ray.direction.y() / ray.direction.z());
    result.centre += ray.origin;
  }
  if (!result.board.empty()) result.centre /= static_cast<double>(result.board.size());
  return result;
}

Pose pose_of(const Perspective& seen, const std::string& image) {
  cv::Vec3d turn, place;
  constexpr std::size_t kLeast = 4;
  if (seen.board.size() < kLeast ||
      !cv::solvePnP(seen.board, seen.directions, cv::Matx33d::eye(), cv::noArray(), turn, place,
                    false, cv::SOLVEPNP_IPPE))
    fail("{}: its {} corners do not tell where the board is", image, seen.board.size());
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  Pose pose;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) pose.rotation(i, j) = rotation(i, j);
  const Eigen::Vector3d from_camera = seen.centre + Eigen::Vector3d(place[0], place[1], place[2]);
  pose.centre = -pose.rotation.transpose() * from_camera;
  return pose;
}

}  // namespace

pose::ColmapBundle board_bundle(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                                std::span<const View> views,
                                std::span<const Eigen::Vector3d> corners,
                                std::span<const Pose> poses) {
  io::Housing housing;
  housing.ports["main"] = io::to_housing_port(port);
  housing.default_port = "main";
  pose::ColmapBundle result =
      pose::to_bundle(model_of(lens, views, corners), std::span(&lens, 1), housing);
  for (std::size_t i = 0; i < views.size(); ++i)
    result.bundle.images[i].pose =
        poses.empty() ? pose_of(perspective_of(result.bundle, i), views[i].image) : poses[i];
  return result;
}

std::vector<Corner> photographed(const pose::ColmapBundle& bundle,
                                 std::span<const Eigen::Vector3d> corners, const Pose& pose) {
  const io::ColmapCamera& lens = bundle.lenses[0];
  const CameraModel now = bundle.bundle.cameras[0].now();
  const auto camera = make_camera<double>(now);
  std::vector<Corner> seen;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto image =
        std::visit([&](const auto& c) { return c.project(pose.to_camera(corners[i])); }, camera);
    if (!image.visible) continue;
    const Eigen::Vector3d bearing = now.lens.bearing(image.pixel);
    const Eigen::Vector2d pixel = io::image_direction(lens, bearing.x(), bearing.y());
    const bool inside = pixel.x() >= 1 && pixel.y() >= 1 &&
                        pixel.x() <= static_cast<double>(lens.width) - 2 &&
                        pixel.y() <= static_cast<double>(lens.height) - 2;
    // What a lens model folds back into the image is not seen there.
    if (inside && io::direction_at(lens, pixel)) seen.push_back({i, pixel});
  }
  return seen;
}

}  // namespace axial::calibrate
