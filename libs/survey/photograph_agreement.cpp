// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/photograph_agreement.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/order_statistics.h"
#include "base/pair_sums.h"

namespace axial::survey {
namespace {

constexpr std::size_t kMostSampledPlaces = 8000, kMostSightsOfPlace = 8;
constexpr double kPatches = 160;    // along the longer side
constexpr double kLeastDetail = 1;  // standard deviation of a photograph that shows something

// The mean of the pixels of `sums`, an integral image, in a square around a pixel.
double mean_around(const cv::Mat1d& sums, const cv::Point& at, int half) {
  const int left = std::max(at.x - half, 0), right = std::min(at.x + half + 1, sums.cols - 1);
  const int top = std::max(at.y - half, 0), bottom = std::min(at.y + half + 1, sums.rows - 1);
  const double sum = sums(bottom, right) - sums(bottom, left) - sums(top, right) + sums(top, left);
  return sum / ((right - left) * (bottom - top));
}

}  // namespace

PhotographSamples::PhotographSamples(const Scene& scene) : images_(scene.images.size()) {
  SceneCameras cameras(scene);
  std::uint32_t number = 0;
  for (const SparsePlace& place :
       spread_places(scene, cameras, kMostSampledPlaces, kMostSightsOfPlace)) {
    for (const PlaceSight& sight : place.sights) {
      const CameraModel& camera = scene.images[sight.image].camera;
      images_[sight.image].samples.push_back(
          {number,
           {(sight.pixel.x() + 0.5) / camera.width, (sight.pixel.y() + 0.5) / camera.height}});
    }
    ++number;
  }
  places_ = number;
}

void PhotographSamples::take(std::size_t image, const cv::Mat3b& pixels) {
  if (image >= images_.size() || pixels.empty()) return;
  cv::Mat1b grey;
  cv::cvtColor(pixels, grey, cv::COLOR_BGR2GRAY);
  take(image, grey);
}

void PhotographSamples::take(std::size_t image, const cv::Mat1b& grey) {
  if (image >= images_.size() || grey.empty()) return;
  {
    const std::scoped_lock lock(mutex_);
    if (std::exchange(images_[image].looked_at, true)) return;
  }
  Image& taken = images_[image];
  cv::Mat1d sums;
  cv::integral(grey, sums, CV_64F);
  cv::Scalar mean, deviation;
  cv::meanStdDev(grey, mean, deviation);
  taken.is_blank = deviation[0] < kLeastDetail;
  const int half = std::max(1, static_cast<int>(std::max(grey.cols, grey.rows) / kPatches / 2));
  for (Sample& sample : taken.samples) {
    const cv::Point at(
        std::clamp(static_cast<int>(sample.pixel.x() * grey.cols), 0, grey.cols - 1),
        std::clamp(static_cast<int>(sample.pixel.y() * grey.rows), 0, grey.rows - 1));
    sample.detail =
        static_cast<float>(mean_around(sums, at, half) - mean_around(sums, at, 4 * half + 1));
  }
}

std::vector<PhotographFacts> PhotographSamples::facts() const {
  std::vector<std::vector<std::pair<std::size_t, float>>> places(places_);  // image, detail
  for (std::size_t i = 0; i < images_.size(); ++i)
    if (images_[i].looked_at && !images_[i].is_blank)
      for (const Sample& sample : images_[i].samples)
        places[sample.place].emplace_back(i, sample.detail);
  std::vector<PhotographFacts> result(images_.size());
  for (std::size_t i = 0; i < images_.size(); ++i) {
    const Image& image = images_[i];
    PhotographFacts& facts = result[i];
    facts.looked_at = image.looked_at;
    facts.is_blank = image.is_blank;
    if (!image.looked_at) continue;
    PairSums pairs;
    for (const Sample& sample : image.samples) {
      std::vector<float> others;
      for (const auto& [other, detail] : places[sample.place])
        if (other != i) others.push_back(detail);
      if (!others.empty())
        pairs.add(static_cast<double>(sample.detail),
                  static_cast<double>(upper_median(std::move(others))));
    }
    facts.samples = static_cast<std::size_t>(pairs.n);
    facts.agreement = pairs.correlation();
  }
  return result;
}

}  // namespace axial::survey
