// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/finders/ring_finder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "targets/codes/ring_codes.h"
#include "targets/finders/ring_decoder.h"
#include "targets/fits/agreement.h"
#include "targets/fits/dot_fit.h"

namespace axial::targets {
namespace {

constexpr int kWindow = 25;      // of the mean that separates black from white [px]
constexpr double kLeastDot = 1;  // smaller half axis of a dot in the picture that is searched [px]
constexpr double kMostDot = 14;  // larger half axis; larger dots are found at a lower resolution
// The noise of the brightness around a dot, as a part of the step across its edge. Bare texture
// that looks like a dot has more.
constexpr double kMostNoise = 0.15;

// True if the area inside the contour is about that of its ellipse, which has a usual shape.
bool is_dot(const std::vector<cv::Point>& contour, const cv::RotatedRect& box) {
  const double small = static_cast<double>(std::min(box.size.width, box.size.height)) / 2;
  const double large = static_cast<double>(std::max(box.size.width, box.size.height)) / 2;
  if (!(small >= kLeastDot && large <= kMostDot && small > 0.2 * large)) return false;
  const double area = cv::contourArea(contour);
  return std::abs(area / (std::numbers::pi * small * large) - 1) < 0.25;
}

// The dots in `picture`, at the pixels of a picture that is `scale` times as large.
std::vector<Ellipse> dots_in(const cv::Mat1f& picture, double scale) {
  cv::Mat1f mean;
  cv::boxFilter(picture, mean, CV_32F, {kWindow, kWindow}, {-1, -1}, true, cv::BORDER_REPLICATE);
  cv::Mat1b bright;
  cv::compare(picture, mean, bright, cv::CMP_GT);
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(bright, contours, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  std::vector<Ellipse> dots;
  for (const auto& contour : contours) {
    if (contour.size() < 6 || static_cast<double>(contour.size()) > 8 * kMostDot) continue;
    const cv::RotatedRect box = cv::fitEllipse(contour);
    if (!is_dot(contour, box)) continue;
    Ellipse dot = ellipse_of(box);
    dot.centre = (dot.centre.array() + 0.5) * scale - 0.5;
    dot.to_circle /= scale;
    dots.push_back(dot);
  }
  return dots;
}

std::vector<Ellipse> dots_of_all_sizes(const cv::Mat1f& grey) {
  cv::Mat1f picture;
  cv::resize(grey, picture, {}, 2, 2, cv::INTER_LINEAR);
  std::vector<Ellipse> dots;
  for (double scale = 0.5; std::min(picture.cols, picture.rows) >= 3 * kWindow; scale *= 2) {
    const std::vector<Ellipse> found = dots_in(picture, scale);
    dots.insert(dots.end(), found.begin(), found.end());
    cv::Mat1f smaller;
    cv::resize(picture, smaller, {picture.cols / 2, picture.rows / 2}, 0, 0, cv::INTER_AREA);
    picture = smaller;
  }
  return dots;
}

// Correlation of the photograph with the ring that was read.
double agreement_of(const cv::Mat1f& grey, const DotFit& fit, const RingReading& ring, int bits) {
  const Eigen::Rotation2Dd turn(-ring.phase);
  const auto to_pattern = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    return turn * (fit.dot.to_circle * (p - fit.dot.centre));
  };
  const double reach = ring.radii.outer + 0.3;
  return agreement(grey, box_of(fit.dot, reach), to_pattern, Pattern(ring.value, bits, ring.radii),
                   reach, fit.blur);
}

std::optional<Detection> read_target(const cv::Mat1f& grey, const Ellipse& dot,
                                     const Family& family, std::span<const std::uint32_t> codes) {
  if (!read_ring(grey, dot, family.bits)) return std::nullopt;
  const auto fit = fit_dot(grey, dot);
  if (!fit || fit->noise > kMostNoise * std::abs(fit->inside - fit->outside)) return std::nullopt;
  const auto ring = read_ring(grey, fit->dot, family.bits);
  if (!ring) return std::nullopt;
  const auto number = ring_number(ring->value, family.bits, codes);
  if (!number) return std::nullopt;
  Detection found;
  found.label = label_of(family, *number);
  found.number = *number;
  found.code = codes[*number - 1];
  found.centre = image_point(fit->dot.centre, fit->covariance);
  found.dot = fit->dot.to_circle;
  found.width = 2 * ring->radii.plate * std::sqrt(half_axes(fit->dot).prod());
  found.agreement = agreement_of(grey, *fit, *ring, family.bits);
  return found;
}

void find_white_rings(const cv::Mat1f& grey, const Family& family, std::vector<Detection>& found) {
  const std::vector<std::uint32_t> codes = ring_codes(family.bits);
  for (const Ellipse& dot : dots_of_all_sizes(grey))
    if (auto target = read_target(grey, dot, family, codes);
        target && target->agreement >= kLeastAgreement)
      found.push_back(std::move(*target));
}

}  // namespace

std::vector<Detection> find_rings(const cv::Mat1f& grey, const Family& family) {
  std::vector<Detection> found;
  find_white_rings(grey, family, found);
  cv::Mat1f negative;
  grey.convertTo(negative, CV_32F, -1);
  find_white_rings(negative, family, found);
  return found;
}

}  // namespace axial::targets
