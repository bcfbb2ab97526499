// SPDX-License-Identifier: GPL-3.0-or-later
// Whether photographs show the same ground at the sparse points that they share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "scene/sparse_places.h"

namespace axial::survey {

// What is known of the photograph of an image.
struct PhotographFacts {
  bool looked_at = false;   // its pixels were given to PhotographSamples::take()
  bool is_blank = false;    // it shows no detail: less than 1 of 255 grey levels of deviation
  std::size_t samples = 0;  // sparse points that it shares with other photographs
  // Correlation of the detail at these points with the median of the same detail in the other
  // photographs: 1 for photographs that agree, about 0 for those that show something else.
  double agreement = 0;
};

// Collects small patches of photographs around sparse points.
//
// The detail of a photograph at a point is the mean grey value of a small square minus that of a
// square with four times the side, so that shading and the colour of the water do not count. The
// small square is 1/160 of the longer side of the photograph, at least 3 px.
class PhotographSamples {
 public:
  // Chooses at most 8,000 sparse points of the scene. `scene` is not used afterwards.
  explicit PhotographSamples(const Scene& scene);

  // Takes the samples of an image. `pixels` are those of the photograph at any resolution. A second
  // photograph for the same image is ignored. May be called concurrently.
  void take(std::size_t image, const cv::Mat3b& pixels);
  void take(std::size_t image, const cv::Mat1b& grey);

  // The facts of all images of the scene, in their order.
  std::vector<PhotographFacts> facts() const;

 private:
  // A sparse point in an image.
  struct Sample {
    std::uint32_t place = 0;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // as a part of the image's width and height
    float detail = 0;
  };
  struct Image {
    std::vector<Sample> samples;
    bool looked_at = false, is_blank = false;
  };

  std::vector<Image> images_;
  std::size_t places_ = 0;
  std::mutex mutex_;
};

}  // namespace axial::survey
