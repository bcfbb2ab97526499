// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether photographs show what tracks and cameras predict: compares small patches of two
// photographs around the images of one point. Tracks may come from other photographs of the same
// views (in air). Then only the photographs tell whether a port is right.
#pragma once

#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "io/colmap/colmap.h"
#include "pose/bundle.h"

namespace axial::pose {

// Up to three pairs of images of a sample with many points in common, with their photographs in
// memory. Photographs that cannot be read, or whose size differs from their camera's, are left out.
class TrackPictures {
 public:
  // `sample`, and its bundle in air with images and points in the same order and points
  // triangulated from the tracks. Both must outlive this.
  TrackPictures(const io::ColmapModel& sample, const Bundle& in_air,
                const std::filesystem::path& image_folder);

  // The median normalised cross-correlation of patches: at the pixels of the tracks (at_tracks), or
  // where the cameras of `bundle` project the points (behind). `bundle` is `in_air` with other
  // cameras or at another scale. 1 for the same picture, near 0 for unrelated places. Empty if
  // fewer than 30 points have enough texture.
  std::optional<double> at_tracks() const;
  std::optional<double> behind(const Bundle& bundle) const;

 private:
  struct Pair {
    std::size_t first, second;                       // images
    std::vector<std::array<std::size_t, 3>> shared;  // the point, its observations in both images
    cv::Mat1f pictures[2];
  };

  void choose_pairs();
  void read_pictures(const std::filesystem::path& image_folder);
  std::optional<double> agreement(const Bundle& bundle, bool at_observations) const;

  const io::ColmapModel& sample_;
  const Bundle& in_air_;
  std::vector<Pair> pairs_;
};

}  // namespace axial::pose
