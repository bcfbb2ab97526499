// SPDX-License-Identifier: GPL-3.0-or-later
// The COLMAP model of the pinhole export, for trainers of splats and for learned reconstruction:
// pinhole cameras, and the sparse points that their images show.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "cloud/pinhole_resampling.h"
#include "scene/scene.h"

namespace axial::densify {

// The memory [bytes] of PinholePoints for `scene`.
std::uint64_t bytes_of_pinhole_points(const Scene& scene);

// An upper bound of the memory [bytes] that write_pinhole_model() needs for all points of `scene`.
std::uint64_t bytes_needed_for_pinhole_model(const Scene& scene);

// The sparse points of a scene in the pinhole images, with their colours there.
class PinholePoints {
 public:
  // No point is found yet. `scene` must outlive the object and keep its points.
  PinholePoints(const Scene& scene, std::span<const std::size_t> images);

  // Finds the points of the image `image` that the picture of its pinhole, `view`, shows: the pixel
  // at the point's projection, rounded to whole pixels, is in the picture, and usable
  // (PinholeImage::usable). Several threads may call this function for different images.
  void find(std::size_t image, const cloud::PinholeView& view, const cloud::PinholeImage& picture);

  // Gives `exported` all points of the scene, with the views in which they were found, and the mean
  // of their colours there. A point that was found in no view has none, and is black.
  void give_to(Scene& exported) const;

 private:
  // A point that an image sees. `shown`: find() has found it; `color`: in the picture.
  struct Seen {
    std::uint32_t point = 0;
    bool shown = false;
    Rgb color{};
  };

  const Scene& scene_;
  std::vector<std::vector<Seen>> of_image_;  // one for each image of the scene
};

// The number of images and points of a model.
struct PinholeModelSize {
  std::size_t images = 0, points = 0;
};

// Writes the binary model of `scene` (io::export_colmap_model()) to `folder`, which is made. The
// coordinates are those of the scene, without the offset of its frame, because trainers calculate
// with float. `images`: the folder below which the images are. Error for a file that cannot be
// written.
PinholeModelSize write_pinhole_model(const std::filesystem::path& folder, const Scene& scene,
                                     const std::filesystem::path& images);

}  // namespace axial::densify
