// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/strip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/order_statistics.h"
#include "scene/decompositions.h"

namespace axial::evaluate {
namespace {

constexpr std::size_t kPiecesOfSpacing = 5;
constexpr double kLargestWidth = 0.25;  // width of a strip / length

Eigen::Matrix3Xd centres_of(std::span<const View> views) {
  Eigen::Matrix3Xd centres(3, static_cast<Eigen::Index>(views.size()));
  for (std::size_t i = 0; i < views.size(); ++i)
    centres.col(static_cast<Eigen::Index>(i)) = views[i].pose.centre;
  return centres;
}

// The direction of the strip, starting at the first view.
Eigen::Vector3d direction_of(const Eigen::Matrix3Xd& centres) {
  const Eigen::Matrix3Xd off = centres.colwise() - centres.rowwise().mean();
  const Eigen::Vector3d along =
      SymmetricEigen3(Eigen::Matrix3d(off * off.transpose())).eigenvectors().col(2);
  return off.col(0).dot(along) < 0 ? along : Eigen::Vector3d(-along);
}

struct Range {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

// Sets `least` and `most`: the smallest and the largest density of the pieces that count, divided
// by the mean.
void compare_pieces(Strip& strip) {
  std::vector<std::size_t> places;
  for (const StripPiece& piece : strip.pieces) places.push_back(piece.places);
  const std::size_t middle = upper_median(std::move(places));
  Range densities;
  std::size_t points = 0, counted = 0;
  for (const StripPiece& piece : strip.pieces) {
    if (piece.places == 0 || 2 * piece.places < middle) continue;
    densities.add(static_cast<double>(piece.points) / static_cast<double>(piece.places));
    points += piece.points;
    counted += piece.places;
  }
  if (points == 0) return;
  const double mean = static_cast<double>(points) / static_cast<double>(counted);
  strip.least = densities.least / mean;
  strip.most = densities.most / mean;
}

}  // namespace

void require_strip(std::span<const View> views) {
  if (views.size() < 3) fail("{} views are not a strip: at least 3 are needed", views.size());
  const double width = relative_width(centres_of(views));
  if (!(width <= kLargestWidth))
    fail("the camera centres are not a strip: they are {:.2f} times as wide as long", width);
}

Strip density_along_strip(std::span<const Eigen::Vector3f> points, const Places& places,
                          std::span<const View> views) {
  require_strip(views);
  Strip strip;
  const Eigen::Matrix3Xd centres = centres_of(views);
  strip.direction = direction_of(centres);
  const double start = centres.col(0).dot(strip.direction);
  const auto along = [&](const Eigen::Vector3f& x) {
    return x.cast<double>().dot(strip.direction) - start;
  };
  Range cameras, ground;
  for (const auto& centre : centres.colwise()) cameras.add(centre.dot(strip.direction));
  for (const Eigen::Vector3f& place : places.positions) ground.add(along(place));
  const double spacing = (cameras.most - cameras.least) / static_cast<double>(views.size() - 1);
  const double length = ground.most - ground.least;
  // Views at (almost) one place would give a huge number of pieces.
  constexpr double kMostPieces = 1e5;
  const double pieces = std::ceil(length / spacing * static_cast<double>(kPiecesOfSpacing));
  if (!(pieces <= kMostPieces))
    fail("the camera centres are not a strip: they are {} m apart", spacing);
  const auto count = std::max<std::size_t>(1, static_cast<std::size_t>(pieces));
  for (std::size_t k = 0; k < count; ++k) {
    const auto at = [&](std::size_t end) {
      return ground.least + length * static_cast<double>(end) / static_cast<double>(count);
    };
    strip.pieces.push_back({at(k), at(k + 1), 0, 0});
  }
  const auto count_in_pieces = [&](std::span<const Eigen::Vector3f> all,
                                   std::size_t StripPiece::*counter) {
    for (const Eigen::Vector3f& x : all) {
      const double part = (along(x) - ground.least) / length;
      if (!(part >= 0 && part <= 1)) continue;
      const auto k = static_cast<std::size_t>(part * static_cast<double>(count));
      ++(strip.pieces[std::min(k, count - 1)].*counter);
    }
  };
  count_in_pieces(points, &StripPiece::points);
  count_in_pieces(places.positions, &StripPiece::places);
  compare_pieces(strip);
  return strip;
}

}  // namespace axial::evaluate
