// SPDX-License-Identifier: GPL-3.0-or-later
// The features of photographs, and which of them show the same place.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "pose/bundle/bundle.h"

namespace axial::pose {

// A match of a feature of one image with a feature of another image.
struct FeatureLink {
  std::uint32_t feature = 0;        // index in the features of the image
  std::uint32_t other_image = 0;    // index into Bundle::images
  std::uint32_t other_feature = 0;  // index in the features of the other image
};

// The features of the images of a bundle and their matches, which may be wrong.
class FeatureMatches {
 public:
  // `features`: the pixels of the features of each image, in the order of Bundle::images. Pixel
  // centres are at integers. Observation::source is the index of a feature of its image.
  explicit FeatureMatches(std::vector<std::vector<Eigen::Vector2d>> features)
      : features_(std::move(features)), links_(features_.size()) {}

  // Adds a match. Precondition: images and features exist, and the images are different.
  void add(std::uint32_t image, std::uint32_t feature, std::uint32_t other_image,
           std::uint32_t other_feature);

  // Sorts the matches. It must be called after the last add(), before links().
  void sort();

  const std::vector<std::vector<Eigen::Vector2d>>& features() const { return features_; }

  // All matches of an image, or of one feature of it: sorted by the feature, the other image and
  // the other feature, each match once.
  std::span<const FeatureLink> links(std::size_t image) const { return links_[image]; }
  std::span<const FeatureLink> links(std::size_t image, std::uint32_t feature) const;

 private:
  std::vector<std::vector<Eigen::Vector2d>> features_;
  std::vector<std::vector<FeatureLink>> links_;  // by image
};

// The index into Bundle::points of a feature that belongs to no point.
inline constexpr std::size_t kNoPoint = std::numeric_limits<std::size_t>::max();

// The points of all features by image and feature, from the observations of the bundle; kNoPoint
// for features without an observation.
std::vector<std::vector<std::size_t>> points_of_features(const Bundle& bundle,
                                                         const FeatureMatches& matches);

}  // namespace axial::pose
