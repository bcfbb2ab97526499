// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/finders/board_finder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <span>

#include "targets/codes/marker_board.h"
#include "targets/fits/agreement.h"
#include "targets/fits/edge_fit.h"

namespace axial::targets {
namespace {

// A place in which two edges cross: the place, and the angles of the normals of the edges. Light
// comes from two opposite quadrants.
struct CrossingShare {
  template <class T>
  T operator()(const T* shape, double x, double y, const T& per_blur) const {
    const T dx = x - shape[0], dy = y - shape[1];
    const T first = inside_share(T((cos(shape[2]) * dx + sin(shape[2]) * dy) * per_blur));
    const T second = inside_share(T((cos(shape[3]) * dx + sin(shape[3]) * dy) * per_blur));
    return first * second + (1.0 - first) * (1.0 - second);
  }
};

// A corner and the ways to the next corners in its row and in its column [px].
struct Crossing {
  Corner corner;
  Eigen::Vector2d along_row, along_column;

  double spacing() const { return std::min(along_row.norm(), along_column.norm()); }
};

// The way from `from` to the next corner on the line of corners whose numbers differ by multiples
// of `step`; `on_line(number)` tells whether a number is on the line.
template <class OnLine>
std::optional<Eigen::Vector2d> way_to_next(const Corner& from, std::span<const Corner> corners,
                                           int step, OnLine on_line) {
  std::optional<Eigen::Vector2d> way;
  int nearest = 0;
  for (const Corner& other : corners) {
    const int apart = (static_cast<int>(other.number) - static_cast<int>(from.number)) / step;
    if (apart == 0 || !on_line(other.number) || (way && std::abs(apart) >= nearest)) continue;
    way = (other.pixel - from.pixel) / apart;
    nearest = std::abs(apart);
  }
  return way;
}

std::vector<Crossing> crossings_of(std::span<const Corner> corners, int columns) {
  const auto width = static_cast<std::size_t>(columns);
  std::vector<Crossing> crossings;
  for (const Corner& corner : corners) {
    const auto along_row = way_to_next(corner, corners, 1, [&](std::size_t number) {
      return number / width == corner.number / width;
    });
    const auto along_column = way_to_next(corner, corners, columns, [&](std::size_t number) {
      return number % width == corner.number % width;
    });
    if (along_row && along_column) crossings.push_back({corner, *along_row, *along_column});
  }
  return crossings;
}

double angle_of_normal(const Eigen::Vector2d& edge) {
  return std::atan2(edge.x(), -edge.y());
}

Eigen::Vector2d unit(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

// The pixels near the edges, up to `reach` from the corner; none if some are outside the picture.
std::vector<cv::Point> pixels_near(const Eigen::Vector4d& shape, double reach, double band,
                                   cv::Size size) {
  std::vector<cv::Point> pixels;
  const cv::Rect whole(cv::Point(), size);
  const auto first = [&](double at) { return static_cast<int>(std::floor(at - reach)); };
  const auto last = [&](double at) { return static_cast<int>(std::ceil(at + reach)); };
  for (int y = first(shape.y()); y <= last(shape.y()); ++y)
    for (int x = first(shape.x()); x <= last(shape.x()); ++x) {
      const Eigen::Vector2d offset = Eigen::Vector2d(x, y) - shape.head<2>();
      const double to_edge =
          std::min(std::abs(unit(shape[2]).dot(offset)), std::abs(unit(shape[3]).dot(offset)));
      if (offset.norm() >= reach || to_edge >= band) continue;
      if (!whole.contains({x, y})) return {};
      pixels.emplace_back(x, y);
    }
  return pixels;
}

// Correlation of the brightness with the share of the light.
class Correlation {
 public:
  void add(double a, double b) {
    const Eigen::Vector2d value(a, b);
    sum_ += value;
    squares_ += value * value.transpose();
    ++count_;
  }
  double value() const {
    const Eigen::Matrix2d covariance = squares_ - sum_ * sum_.transpose() / count_;
    const double scale = std::sqrt(covariance(0, 0) * covariance(1, 1));
    return scale > 0 ? covariance(0, 1) / scale : 0;
  }

 private:
  Eigen::Vector2d sum_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares_ = Eigen::Matrix2d::Zero();
  double count_ = 0;
};

double share_at(const Eigen::Vector4d& shape, const cv::Point& pixel, double blur) {
  return CrossingShare{}(shape.data(), static_cast<double>(pixel.x), static_cast<double>(pixel.y),
                         1 / blur);
}

double agreement_of(const cv::Mat1f& grey, const Eigen::Vector4d& shape, double blur,
                    std::span<const cv::Point> pixels) {
  Correlation correlation;
  for (const cv::Point& pixel : pixels)
    correlation.add(share_at(shape, pixel, blur), static_cast<double>(grey(pixel)));
  return correlation.value();
}

// With the brightness of the quadrants that the first guess says.
EdgeFit<4> crossing_start(const cv::Mat1f& grey, Eigen::Vector4d shape,
                          std::span<const cv::Point> pixels) {
  constexpr double kBlur = 0.7;
  const auto [low, high] =
      std::ranges::minmax(pixels, {}, [&](const cv::Point& p) { return grey(p); });
  // The other pair of quadrants is the bright one.
  if (agreement_of(grey, shape, kBlur, pixels) < 0) shape[3] += std::numbers::pi;
  EdgeFit<4> start;
  start.shape = shape;
  start.inside = static_cast<double>(grey(high));
  start.outside = static_cast<double>(grey(low));
  start.blur = kBlur;
  return start;
}

// `gap`: of the board between the side of a square and the marker in it, as a part of the side.
std::optional<Detection> measure_crossing(const cv::Mat1f& grey, const Crossing& crossing,
                                          double gap) {
  const Eigen::Vector2d& guess = crossing.corner.pixel;
  const Eigen::Vector4d shape(guess.x(), guess.y(), angle_of_normal(crossing.along_row),
                              angle_of_normal(crossing.along_column));
  const double spacing = crossing.spacing();
  const double reach = std::min(40.0, spacing / 2);
  const double band = std::clamp(gap * spacing - 1.4, 1.1, 6.0);
  const std::vector<cv::Point> pixels = pixels_near(shape, reach, band, grey.size());
  if (pixels.empty()) return std::nullopt;
  const auto fit = fit_edge<4>(grey, pixels, crossing_start(grey, shape, pixels), CrossingShare{});
  if (!fit || (fit->shape.head<2>() - guess).norm() > std::max(1.0, 0.2 * spacing))
    return std::nullopt;
  Detection found;
  found.centre = image_point(fit->shape.head<2>(), fit->covariance.topLeftCorner<2, 2>());
  found.width = spacing;
  found.agreement = agreement_of(grey, fit->shape, fit->blur, pixels);
  if (found.agreement < kLeastAgreement) return std::nullopt;
  return found;
}

// OpenCV's detector works on 8 bits. Haze leaves little of their range, so it is spread locally.
cv::Mat1b spread(const cv::Mat1f& grey) {
  cv::Mat1b picture;
  grey.convertTo(picture, CV_8U);
  cv::createCLAHE(3, {8, 8})->apply(picture, picture);
  return picture;
}

}  // namespace

std::vector<Detection> find_board_corners(const cv::Mat1f& grey, const Family& family) {
  const Board& board = family.board;
  const std::vector<Corner> corners = find_marker_corners(spread(grey), board);
  const double gap = (board.size - board.second) / 2 / board.size;
  std::vector<Detection> found;
  for (const Crossing& crossing : crossings_of(corners, board.columns - 1)) {
    auto detection = measure_crossing(grey, crossing, gap);
    if (!detection) continue;
    detection->number = detection->code = crossing.corner.number;
    detection->label = label_of(family, detection->number);
    found.push_back(std::move(*detection));
  }
  return found;
}

}  // namespace axial::targets
