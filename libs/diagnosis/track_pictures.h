// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether photographs agree with tracks and cameras: compares small patches of two
// photographs, at the two places where the tracks or the cameras have the images of one point. The
// tracks alone are not enough: they may come from photographs of the same views that were taken in
// air, and then contain no refraction. In this case only the pixels of the underwater photographs
// show whether a port is right.
#pragma once

#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "io/colmap/colmap.h"
#include "pose/bundle/bundle.h"

namespace axial::diagnosis {

// Up to three pairs of images of a sample, with their photographs in memory. The images of a pair
// have many points in common, and no image is in two pairs. A pair is not used if one of its
// photographs cannot be read or has another size than its camera.
class TrackPictures {
 public:
  // `in_air`: the bundle of `sample` with its cameras in air. Images and points have the same order
  // as in `sample`, and the points are triangulated from the tracks. Both objects must outlive this
  // object. `image_folder`: the folder to which the names of the images are relative.
  TrackPictures(const io::ColmapModel& sample, const pose::Bundle& in_air,
                const std::filesystem::path& image_folder);

  // Both functions return the median of the normalised cross-correlations of corresponding patches:
  // 1 for equal patches, near 0 for unrelated places. at_tracks() centres the patches at the pixels
  // of the tracks. behind() centres the patches at the projections of the points into the cameras
  // of `bundle`, which is `in_air` with other cameras or at another scale. Empty if fewer than 30
  // points of all pairs together have patches that lie in both photographs and have enough texture.
  std::optional<double> at_tracks() const;
  std::optional<double> behind(const pose::Bundle& bundle) const;

 private:
  struct Pair {
    std::size_t first, second;                       // images
    std::vector<std::array<std::size_t, 3>> shared;  // the point, its observations in both images
    cv::Mat1f pictures[2];
  };

  void choose_pairs();
  void read_pictures(const std::filesystem::path& image_folder);
  std::optional<double> agreement(const pose::Bundle& bundle, bool at_observations) const;

  const io::ColmapModel& sample_;
  const pose::Bundle& in_air_;
  std::vector<Pair> pairs_;
};

}  // namespace axial::diagnosis
