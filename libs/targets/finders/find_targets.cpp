// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/finders/find_targets.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "base/order_statistics.h"
#include "targets/finders/board_finder.h"
#include "targets/finders/ring_finder.h"
#include "targets/finders/square_finder.h"

namespace axial::targets {
namespace {

// Few pixels are brighter: stars of plankton and broken pixels do not count.
float brightness_of_light_areas(const cv::Mat1f& grey) {
  cv::Mat1f small;
  const double shrink = std::min(1.0, 1000.0 / std::max(grey.cols, grey.rows));
  cv::resize(grey, small, {}, shrink, shrink, cv::INTER_NEAREST);
  return lower_quantile(std::vector<float>(small.begin(), small.end()), 0.999);
}

// The brightness from about 0 to 255, with the fractions of photographs of 16 bits.
cv::Mat1f grey_of(const cv::Mat& photograph) {
  cv::Mat grey = photograph;
  if (photograph.channels() == 3) cv::cvtColor(photograph, grey, cv::COLOR_BGR2GRAY);
  cv::Mat1f result;
  grey.convertTo(result, CV_32F);
  if (grey.depth() == CV_16U) result *= 255 / std::max(1.f, brightness_of_light_areas(result));
  return result;
}

// Keeps the best of the detections of one target at one place.
std::vector<Detection> without_repetitions(std::vector<Detection> all) {
  std::ranges::sort(all, std::ranges::greater{}, &Detection::agreement);
  std::vector<Detection> kept;
  for (Detection& candidate : all) {
    const auto repeats = [&](const Detection& other) {
      return (other.centre.pixel - candidate.centre.pixel).norm() <
             0.3 * std::max(other.width, candidate.width);
    };
    if (std::ranges::none_of(kept, repeats)) kept.push_back(std::move(candidate));
  }
  std::ranges::sort(kept, {}, [](const Detection& d) {
    return std::tuple(d.number, d.centre.pixel.y(), d.centre.pixel.x());
  });
  return kept;
}

std::vector<Detection> find_family(const cv::Mat1f& grey, const Family& family) {
  switch (family.kind) {
    case Kind::ring:
      return find_rings(grey, family);
    case Kind::square:
      return find_squares(grey, family);
    case Kind::board:
      break;
  }
  return find_board_corners(grey, family);
}

}  // namespace

std::uint64_t bytes_of_search(cv::Size size) {
  // Grey and its negative, both pictures of twice the resolution with their means, masks and
  // contours.
  constexpr std::uint64_t kBytesPerPixel = 80;
  return kBytesPerPixel * static_cast<std::uint64_t>(size.area());
}

std::vector<Detection> find_targets(const cv::Mat& photograph, std::span<const Family> families) {
  const cv::Mat1f grey = grey_of(photograph);
  std::vector<Detection> all;
  for (const Family& family : families) {
    std::vector<Detection> found = without_repetitions(find_family(grey, family));
    std::ranges::move(found, std::back_inserter(all));
  }
  return all;
}

}  // namespace axial::targets
