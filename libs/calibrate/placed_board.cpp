// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/placed_board.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "io/colmap/colmap_lens.h"

namespace axial::calibrate {
namespace {

constexpr double kTurnDegrees = 35;

using Box = Eigen::AlignedBox2d;

Box box_of(std::span<const Corner> corners) {
  Box box;
  for (const Corner& corner : corners) box.extend(corner.pixel);
  return box;
}

// Places the board in front of the camera of a bundle.
class BoardPlacer {
 public:
  BoardPlacer(const pose::ColmapBundle& bundle, std::span<const Eigen::Vector3d> corners)
      : bundle_(bundle), corners_(corners), camera_(bundle.bundle.cameras[0].now()) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& corner : corners) box.extend(corner);
    middle_ = box.center();
    extent_ = box.sizes();
  }

  // The distance at which the board, facing the camera, is as wide or high as `share` of the image.
  // Uses the angle between the rays of neighbouring pixels in the middle of the image.
  double distance_for(double share) const {
    const auto angle = [&](const Eigen::Vector2d& step) {
      const Eigen::Vector2d& middle = camera_.principal_point();
      return (camera_.ray(middle + step / 2).direction - camera_.ray(middle - step / 2).direction)
          .norm();
    };
    const double across = width() * angle({1, 0}), down = height() * angle({0, 1});
    return std::max(extent_.x() / across, extent_.y() / down) / share;
  }

  // Shifts the board until it touches the edges that its place names; false if it does not fit.
  bool place(PlacedBoard& placed) const {
    const Eigen::Matrix3d rotation = rotation_of(placed);
    Eigen::Vector2d at(0, 0);  // the middle's x and y divided by the distance
    constexpr int kSteps = 12;
    for (int step = 0; step < kSteps; ++step) {
      const Eigen::Vector3d middle = placed.distance * Eigen::Vector3d(at.x(), at.y(), 1);
      placed.pose = {rotation, middle_ - rotation.transpose() * middle};
      placed.corners = photographed(bundle_, corners_, placed.pose);
      if (placed.corners.size() < corners_.size()) {
        at *= 0.8;  // the board left the image
        continue;
      }
      const Eigen::Vector2d miss = miss_of(placed);
      if (step + 1 == kSteps || miss.norm() < 2) break;
      const auto lens = io::lens_of(bundle_.lenses[0]).pinhole;
      at += 0.5 * Eigen::Vector2d(miss.x() / lens.fx, miss.y() / lens.fy);
    }
    return placed.corners.size() == corners_.size();
  }

 private:
  double width() const { return static_cast<double>(bundle_.lenses[0].width); }
  double height() const { return static_cast<double>(bundle_.lenses[0].height); }

  static Eigen::Matrix3d rotation_of(const PlacedBoard& placed) {
    const double angle = kTurnDegrees * std::numbers::pi / 180;
    // The y axis points down: a positive rotation about it brings the right side nearer.
    return (Eigen::AngleAxisd(placed.turned * angle, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(-placed.tipped * angle, Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
  }

  // The shift [px] from the board's place in the image to the desired place.
  Eigen::Vector2d miss_of(const PlacedBoard& placed) const {
    const Box box = box_of(placed.corners);
    const double margin = 0.02 * width();
    const auto along = [&](int where, double low, double high, double size) {
      if (where < 0) return margin - low;
      if (where > 0) return size - margin - high;
      return (size - low - high) / 2;
    };
    return {along(placed.column, box.min().x(), box.max().x(), width()),
            along(placed.row, box.min().y(), box.max().y(), height())};
  }

  const pose::ColmapBundle& bundle_;
  std::span<const Eigen::Vector3d> corners_;
  pose::PhotographCamera camera_;
  Eigen::Vector3d middle_, extent_;
};

std::string place_of(int column, int row) {
  constexpr std::array<const char*, 9> kPlaces{
      "upper left corner", "upper edge",        "upper right corner", "left edge",         "middle",
      "right edge",        "lower left corner", "lower edge",         "lower right corner"};
  return kPlaces[static_cast<std::size_t>(3 * (row + 1) + column + 1)];
}

std::string side_of(const PlacedBoard& placed) {
  if (placed.turned != 0) return placed.turned < 0 ? "left" : "right";
  return placed.tipped < 0 ? "upper" : "lower";
}

}  // namespace

std::vector<PlacedBoard> placed_boards(const pose::ColmapBundle& bundle,
                                       std::span<const Eigen::Vector3d> corners,
                                       double least_distance) {
  const BoardPlacer placer(bundle, corners);
  constexpr std::array<std::pair<int, int>, 5> kTurns{{{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  std::vector<PlacedBoard> boards;
  for (const double share : {0.8, 0.4})
    for (const auto& [turned, tipped] : kTurns)
      for (int row = -1; row <= 1; ++row)
        for (int column = -1; column <= 1; ++column) {
          PlacedBoard placed{column, row, 0, turned, tipped, {}, {}};
          placed.distance = std::max(least_distance, placer.distance_for(share));
          if (placer.place(placed)) boards.push_back(std::move(placed));
        }
  return boards;
}

std::string words_for(const PlacedBoard& placed) {
  const std::string where = fmt::format("the board {} the image's {}, {:.2f} m away",
                                        placed.column == 0 && placed.row == 0 ? "in" : "at",
                                        place_of(placed.column, placed.row), placed.distance);
  if (placed.turned == 0 && placed.tipped == 0) return where + ", facing the camera";
  return fmt::format("{}, turned by {} degrees so that its {} side is nearer", where, kTurnDegrees,
                     side_of(placed));
}

}  // namespace axial::calibrate
