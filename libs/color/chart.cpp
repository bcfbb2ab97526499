// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/chart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <opencv2/mcc.hpp>

#include "base/order_statistics.h"
#include "base/pair_sums.h"
#include "color/difference.h"
#include "color/transfer.h"

namespace axial::color {
namespace {

// Sizes of the chart, in units of which a patch has 2.5: patches and gaps of 0.25 around each.
constexpr float kPatch = 2.5f, kGap = 0.25f;
constexpr int kColumns = 6, kRows = 4;
constexpr float kWidth = kColumns * (kPatch + kGap) + kGap,
                kHeight = kRows * (kPatch + kGap) + kGap;

// The length of a chart in a picture in which it is looked at closely [px].
constexpr double kClose = 800;

// OpenCV's detector enlarges pictures so that the shorter side has this length [px].
constexpr int kDetectorSide = 1000;
constexpr int kMostCharts = 4;
constexpr double kLongestSide = 2000;  // of the picture in which charts are looked for [px]

double reduction_of(cv::Size size) {
  return std::min(1.0, kLongestSide / static_cast<double>(std::max(size.width, size.height)));
}

// OpenCV's detector throws for some pictures without a chart.
std::vector<Chart> detect(const cv::Mat& pixels, int most) {
  std::vector<Chart> charts;
  try {
    const auto detector = cv::mcc::CCheckerDetector::create();
    if (!detector->process(pixels, cv::mcc::MCC24, most)) return charts;
    for (const auto& found : detector->getListColorChecker()) {
      const std::vector<cv::Point2f> box = found->getBox();
      if (box.size() == 4) charts.push_back({{box[0], box[1], box[2], box[3]}});
    }
  } catch (const cv::Exception& error) {
    if (error.code == cv::Error::StsNoMem) throw;
    charts.clear();
  }
  return charts;
}

Chart moved(const Chart& chart, double scale, const cv::Point2f& origin) {
  Chart moved = chart;
  for (cv::Point2f& corner : moved.corners) corner = origin + corner * scale;
  return moved;
}

// Longest distance between neighbouring corners [px].
double length_of(const Chart& chart) {
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i)
    longest = std::max(longest, cv::norm(chart.corners[(i + 1) % 4] - chart.corners[i]));
  return longest;
}

// Whether the middle of one chart lies in the other.
bool overlap(const Chart& one, const Chart& other) {
  const auto middle = [](const Chart& chart) {
    return (chart.corners[0] + chart.corners[1] + chart.corners[2] + chart.corners[3]) / 4;
  };
  return cv::pointPolygonTest(other.corners, middle(one), false) >= 0 ||
         cv::pointPolygonTest(one.corners, middle(other), false) >= 0;
}

// The chart again, in an enlarged part of the photograph: corners of small charts are off by a
// patch otherwise. Empty if it is not found there.
std::vector<Chart> seen_closely(const cv::Mat3b& pixels, const Chart& chart) {
  const auto margin = static_cast<int>(length_of(chart) / 3);
  cv::Rect part = cv::boundingRect(std::vector(chart.corners.begin(), chart.corners.end()));
  part = cv::Rect(part.x - margin, part.y - margin, part.width + 2 * margin,
                  part.height + 2 * margin) &
         cv::Rect(cv::Point(), pixels.size());
  if (std::min(part.width, part.height) < margin) return {};  // most of it is outside
  const double scale = kClose / std::max(length_of(chart), 1.0);
  cv::Mat enlarged;
  cv::resize(pixels(part), enlarged, {}, scale, scale,
             scale > 1 ? cv::INTER_CUBIC : cv::INTER_AREA);
  std::vector<Chart> again = detect(enlarged, 1);
  for (Chart& one : again) one = moved(one, 1 / scale, part.tl());
  return again;
}

}  // namespace

std::array<Eigen::Array3f, kPatches> chart_colors() {
  constexpr std::array<std::array<int, 3>, kPatches> kValues{
      {{115, 82, 68},   {194, 150, 130}, {98, 122, 157}, {87, 108, 67},   {133, 128, 177},
       {103, 189, 170}, {214, 126, 44},  {80, 91, 166},  {193, 90, 99},   {94, 60, 108},
       {157, 188, 64},  {224, 163, 46},  {56, 61, 150},  {70, 148, 73},   {175, 54, 60},
       {231, 199, 31},  {187, 86, 149},  {8, 133, 161},  {243, 243, 242}, {200, 200, 200},
       {160, 160, 160}, {122, 122, 121}, {85, 85, 85},   {52, 52, 52}}};
  const Transfer srgb;
  std::array<Eigen::Array3f, kPatches> colors;
  for (std::size_t i = 0; i < kPatches; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      colors[i][static_cast<Eigen::Index>(k)] =
          srgb.light(static_cast<float>(kValues[i][k]) / 255.0f);
  return colors;
}

std::vector<Chart> find_charts(const cv::Mat3b& pixels) {
  const double scale = reduction_of(pixels.size());
  cv::Mat reduced;
  cv::resize(pixels, reduced, {}, scale, scale, cv::INTER_AREA);
  std::vector<Chart> charts;
  for (const Chart& found : detect(reduced, kMostCharts))
    for (const Chart& chart : seen_closely(pixels, moved(found, 1 / scale, {})))
      if (std::ranges::none_of(charts, [&](const Chart& one) { return overlap(one, chart); }))
        charts.push_back(chart);
  return charts;
}

std::uint64_t bytes_to_find_charts(cv::Size size) {
  // Of a pixel of the enlarged picture: colours as bytes and as floats, grey, and nine pictures of
  // thresholds.
  constexpr double kEachPixel = 3 + 12 + 1 + 9;
  const double width = size.width * reduction_of(size), height = size.height * reduction_of(size);
  const double shorter = std::max(1.0, std::min(width, height));
  const double scale = std::max(1.0, kDetectorSide / shorter);
  return static_cast<std::uint64_t>(kEachPixel * scale * scale * width * height);
}

double likeness(const PatchLights& lights, const std::array<bool, 3>& known) {
  const auto colors = chart_colors();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
    if (known[static_cast<std::size_t>(k)]) {
      PairSums sums;
      for (std::size_t i = 0; i < kPatches; ++i)
        if (std::isfinite(lights[i][k]))
          sums.add(static_cast<double>(lights[i][k]), static_cast<double>(colors[i][k]));
      least = std::min(least, sums.n < kPatches / 2 ? 0 : sums.correlation());
    }
  return std::isfinite(least) ? least : 0;
}

std::vector<cv::Point> pixels_of_patch(const Chart& chart, std::size_t patch, cv::Size size) {
  constexpr float kMiddle = 0.25f * kPatch;  // half a side of the part that is used
  const auto column = static_cast<float>(patch % kColumns);
  const auto row = static_cast<float>(patch / kColumns);
  const cv::Point2f centre(kGap + kPatch / 2 + column * (kPatch + kGap),
                           kGap + kPatch / 2 + row * (kPatch + kGap));
  const std::array<cv::Point2f, 4> whole{{{0, 0}, {kWidth, 0}, {kWidth, kHeight}, {0, kHeight}}};
  const cv::Mat to_image = cv::getPerspectiveTransform(whole.data(), chart.corners.data());
  std::vector<cv::Point2f> corners;
  cv::perspectiveTransform(std::vector<cv::Point2f>{centre + cv::Point2f(-kMiddle, -kMiddle),
                                                    centre + cv::Point2f(kMiddle, -kMiddle),
                                                    centre + cv::Point2f(kMiddle, kMiddle),
                                                    centre + cv::Point2f(-kMiddle, kMiddle)},
                           corners, to_image);
  const cv::Rect part = cv::boundingRect(corners) & cv::Rect(cv::Point(), size);
  std::vector<cv::Point> inside;
  for (int y = part.y; y < part.br().y; ++y)
    for (int x = part.x; x < part.br().x; ++x)
      if (cv::pointPolygonTest(corners, cv::Point2f(cv::Point(x, y)), false) >= 0)
        inside.emplace_back(x, y);
  return inside;
}

Eigen::Array3f gain_of(const PatchLights& lights) {
  constexpr std::size_t kFirst = 18, kGreys = 5;
  const auto colors = chart_colors();
  Eigen::Array3f gain;
  for (int k = 0; k < 3; ++k) {
    std::vector<float> ratios;
    for (std::size_t i = kFirst; i < kFirst + kGreys; ++i)
      if (lights[i][k] > 0) ratios.push_back(colors[i][k] / lights[i][k]);
    gain[k] = ratios.size() < 3 ? std::numeric_limits<float>::quiet_NaN()
                                : static_cast<float>(mean_median(std::move(ratios)));
  }
  return gain;
}

double chart_error(const PatchLights& lights, const Eigen::Array3f& gain) {
  const auto colors = chart_colors();
  std::vector<double> differences;
  for (std::size_t i = 0; i < kPatches; ++i)
    if (lights[i].isFinite().all() && gain.isFinite().all())
      differences.push_back(ciede2000(lab_of((lights[i] * gain).max(0.0f)), lab_of(colors[i])));
  if (differences.size() < kPatches / 2 || !gain.isFinite().all())
    return std::numeric_limits<double>::quiet_NaN();
  return upper_median(std::move(differences));
}

}  // namespace axial::color
