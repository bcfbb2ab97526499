// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/finders/square_finder.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "base/plane_cross.h"
#include "targets/codes/dictionary.h"
#include "targets/fits/agreement.h"
#include "targets/fits/corner_fit.h"

namespace axial::targets {
namespace {

using Corners = std::array<Eigen::Vector2d, 4>;  // pixel centres are integers

// The outlines of dark quadrilaterals in `picture`, at the pixels of a picture that is `scale`
// times as large. OpenCV decodes only the larger ones, so its decoding is not used.
void detect(const cv::Mat1b& picture, double scale, int dictionary_number,
            std::vector<Corners>& outlines) {
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->minMarkerPerimeterRate = 40.0 / std::max(picture.cols, picture.rows);
  parameters->adaptiveThreshWinSizeMax = 43;
  std::vector<std::vector<cv::Point2f>> decoded, others;
  std::vector<int> numbers;
  cv::aruco::detectMarkers(picture, dictionary(dictionary_number), decoded, numbers, parameters,
                           others);
  decoded.insert(decoded.end(), others.begin(), others.end());
  for (const auto& quadrilateral : decoded) {
    Corners corners;
    for (std::size_t k = 0; k < 4; ++k)
      corners[k] = {(static_cast<double>(quadrilateral[k].x) + 0.5) * scale - 0.5,
                    (static_cast<double>(quadrilateral[k].y) + 0.5) * scale - 0.5};
    outlines.push_back(corners);
  }
}

// OpenCV's detector works on 8 bits. Haze leaves little of their range, so it is spread locally.
std::vector<Corners> detect_at_all_sizes(const cv::Mat1f& grey, const Family& family) {
  cv::Mat1b picture;
  grey.convertTo(picture, CV_8U);
  cv::createCLAHE(3, {8, 8})->apply(picture, picture);
  std::vector<Corners> outlines;
  cv::Mat1b larger;
  cv::resize(picture, larger, {}, 2, 2, cv::INTER_CUBIC);
  detect(larger, 0.5, family.dictionary, outlines);
  for (double scale = 1; std::min(picture.cols, picture.rows) >= 60; scale *= 2) {
    detect(picture, scale, family.dictionary, outlines);
    cv::Mat1b smaller;
    cv::resize(picture, smaller, {picture.cols / 2, picture.rows / 2}, 0, 0, cv::INTER_AREA);
    picture = smaller;
  }
  return outlines;
}

// The homography from pixels to the plane of the pattern, where the marker has `half` cells to
// either side.
Eigen::Matrix3d to_pattern_of(const Corners& corners, double half) {
  std::array<cv::Point2f, 4> from;
  for (std::size_t k = 0; k < 4; ++k)
    from[k] = {static_cast<float>(corners[k].x()), static_cast<float>(corners[k].y())};
  const auto h = static_cast<float>(half);
  const std::array<cv::Point2f, 4> to{{{-h, -h}, {h, -h}, {h, h}, {-h, h}}};
  const cv::Matx33d matrix = cv::getPerspectiveTransform(from.data(), to.data());
  Eigen::Matrix3d homography;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) homography(i, k) = matrix(i, k);
  return homography;
}

double area_of(const Corners& corners) {
  double twice = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    twice += plane_cross(corners[k], corners[(k + 1) % 4]);
  }
  return std::abs(twice) / 2;
}

Eigen::Vector2d intersection_of_diagonals(const Corners& corners) {
  Eigen::Matrix2d directions;
  directions << corners[2] - corners[0], corners[1] - corners[3];
  const Eigen::Vector2d along = directions.inverse() * (corners[1] - corners[0]);
  return corners[0] + along.x() * (corners[2] - corners[0]);
}

// The variance of each coordinate of the intersection [px^2], by differences.
double variance_of_intersection(const Corners& corners, const std::array<ImagePoint, 4>& points) {
  constexpr double kStep = 1e-3;  // [px]
  const Eigen::Vector2d centre = intersection_of_diagonals(corners);
  double variance = 0;
  for (std::size_t k = 0; k < 4; ++k)
    for (int axis = 0; axis < 2; ++axis) {
      Corners moved = corners;
      moved[k](axis) += kStep;
      const double change = (intersection_of_diagonals(moved) - centre).norm() / kStep;
      variance += std::pow(change * points[k].sigma, 2) / 2;
    }
  return variance;
}

struct Refined {
  Corners corners;
  std::array<ImagePoint, 4> points;
  double blur = 0;  // mean of the corners
};

std::optional<Refined> refine(const cv::Mat1f& grey, const Corners& corners, double cell) {
  Refined refined;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto fit = fit_corner(grey, corners[(k + 3) % 4], corners[k], corners[(k + 1) % 4], cell);
    if (!fit) return std::nullopt;
    refined.corners[k] = fit->pixel;
    refined.points[k] = image_point(fit->pixel, fit->covariance);
    refined.blur += fit->blur / 4;
  }
  return refined;
}

// The corners of the plate around the marker.
cv::Rect box_of(const Corners& corners) {
  Eigen::Vector2d low = corners[0], high = corners[0];
  for (const Eigen::Vector2d& c : corners) low = low.cwiseMin(c), high = high.cwiseMax(c);
  const Eigen::Vector2d margin = 0.25 * (high - low);
  low -= margin, high += margin;
  return {cv::Point(static_cast<int>(low.x()), static_cast<int>(low.y())),
          cv::Point(static_cast<int>(high.x()) + 2, static_cast<int>(high.y()) + 2)};
}

double agreement_of(const cv::Mat1f& grey, const Refined& marker, const Pattern& pattern) {
  const Eigen::Matrix3d homography = to_pattern_of(marker.corners, pattern.half_marker());
  const auto to_pattern = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    return (homography * p.homogeneous()).hnormalized();
  };
  return agreement(grey, box_of(marker.corners), to_pattern, pattern, pattern.half_marker() + 0.5,
                   marker.blur);
}

// The brightness at the middle of each cell of the marker and of its margin, which are `cells` to a
// side.
cv::Mat1f cells_of(const cv::Mat1f& grey, const Corners& corners, int cells) {
  const Eigen::Matrix3d to_pixel =
      to_pattern_of(corners, static_cast<double>(cells - 2) / 2).inverse();
  constexpr int kSamples = 3;  // along each side of a cell
  const cv::Rect box = box_of(corners) & cv::Rect(0, 0, grey.cols, grey.rows);
  cv::Mat2f places(cells * kSamples, cells * kSamples);
  for (int y = 0; y < places.rows; ++y)
    for (int x = 0; x < places.cols; ++x) {
      // The middle half of a cell.
      const auto place = [&](int i) {
        return i / kSamples + 0.5 + 0.25 * (i % kSamples - 1) - 0.5 * cells;
      };
      const Eigen::Vector2d p = (to_pixel * Eigen::Vector3d(place(x), place(y), 1)).hnormalized();
      places(y, x) = {static_cast<float>(p.x() - box.x), static_cast<float>(p.y() - box.y)};
    }
  cv::Mat1f samples;
  cv::remap(grey(box), samples, places, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::resize(samples, samples, {cells, cells}, 0, 0, cv::INTER_AREA);
  return samples;
}

// The mean of the cells that are `depth` cells from the edge of `cells`.
double mean_of_frame(const cv::Mat1f& cells, int depth) {
  double sum = 0;
  int count = 0;
  const int last = cells.rows - 1;
  for (int y = 0; y <= last; ++y)
    for (int x = 0; x <= last; ++x)
      if (std::min({x, y, last - x, last - y}) == depth)
        sum += static_cast<double>(cells(y, x)), ++count;
  return sum / count;
}

struct Decoded {
  std::size_t number = 0;
  int turns = 0;  // quarter turns of the marker
};

std::optional<Decoded> decode(const cv::Mat1f& grey, const Corners& corners, const Family& family) {
  const auto markers = dictionary(family.dictionary);
  const cv::Mat1f cells = cells_of(grey, corners, markers->markerSize + 4);
  const double margin = mean_of_frame(cells, 0), border = mean_of_frame(cells, 1);
  if (border >= margin) return std::nullopt;
  cv::Mat1b bits;
  cv::compare(cells(cv::Rect(2, 2, markers->markerSize, markers->markerSize)),
              (border + margin) / 2, bits, cv::CMP_GT);
  bits &= 1;
  int number = 0, turns = 0;
  if (!markers->identify(bits, number, turns, 0.6)) return std::nullopt;
  return Decoded{static_cast<std::size_t>(number), turns};
}

double shortest_side(const Corners& corners) {
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 4; ++k)
    shortest = std::min(shortest, (corners[(k + 1) % 4] - corners[k]).norm());
  return shortest;
}

Detection detection_of(const Refined& marker, const Pattern& pattern, double agrees) {
  Detection found;
  found.centre = {intersection_of_diagonals(marker.corners).array() + 0.5,
                  std::sqrt(variance_of_intersection(marker.corners, marker.points))};
  found.corners = marker.points;
  found.width = std::sqrt(area_of(marker.corners)) * pattern.half_plate() / pattern.half_marker();
  found.agreement = agrees;
  return found;
}

std::optional<Detection> measure(const cv::Mat1f& grey, const Corners& outline,
                                 const Family& family) {
  const double cells = dictionary(family.dictionary)->markerSize + 2;
  auto refined = refine(grey, outline, shortest_side(outline) / cells);
  if (!refined) return std::nullopt;
  const auto decoded = decode(grey, refined->corners, family);
  if (!decoded) return std::nullopt;
  // identify() counts the turns that bring the bits of the picture to those of the dictionary.
  const auto first = static_cast<std::ptrdiff_t>((4 - decoded->turns) % 4);
  const auto turn = [first](auto& four) {
    std::rotate(four.begin(), four.begin() + first, four.end());
  };
  turn(refined->corners);
  turn(refined->points);
  const Pattern pattern(family, decoded->number);
  const double agrees = agreement_of(grey, *refined, pattern);
  if (agrees < kLeastAgreement) return std::nullopt;
  Detection found = detection_of(*refined, pattern, agrees);
  found.label = label_of(family, decoded->number);
  found.number = decoded->number;
  found.code = decoded->number;
  return found;
}

}  // namespace

std::vector<Detection> find_squares(const cv::Mat1f& grey, const Family& family) {
  std::vector<Detection> found;
  for (const Corners& outline : detect_at_all_sizes(grey, family))
    if (auto target = measure(grey, outline, family)) found.push_back(std::move(*target));
  return found;
}

}  // namespace axial::targets
