// SPDX-License-Identifier: GPL-3.0-or-later
// Whether photographs show what tracks and cameras predict: small patches of two photographs at the
// places of one point, compared. Tracks may come from other photographs of the same views (in air),
// and then only the pictures tell whether a port is right.
#pragma once

#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "io/colmap.h"
#include "pose/bundle.h"

namespace axial::pose {

// Up to three pairs of images of a sample that see many points in common, their photographs in
// memory. Photographs that cannot be read, or are of another size than their camera, are left out.
class TrackPictures {
 public:
  // `sample` and its bundle in air, images and points in the same order; the points lie where the
  // tracks' rays meet. Both must outlive this.
  TrackPictures(const io::ColmapModel& sample, const Bundle& in_air,
                const std::filesystem::path& image_folder);

  // How alike patches are at the tracks' own pixels, and where the cameras of `bundle` (in_air with
  // other cameras, or in another scale) see the points: the median of the normalised
  // cross-correlation, 1 for the same picture, near 0 for places that have nothing in common.
  // Nothing, where fewer than 30 points have enough texture.
  std::optional<double> at_tracks() const;
  std::optional<double> behind(const Bundle& bundle) const;

 private:
  struct Pair {
    std::size_t first, second;                       // images
    std::vector<std::array<std::size_t, 3>> shared;  // point, its observations in both
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
