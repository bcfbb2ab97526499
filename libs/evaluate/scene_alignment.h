// SPDX-License-Identifier: GPL-3.0-or-later
// Similarities from the cameras of a scene to known positions or to another scene.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene/decompositions.h"
#include "scene/scene.h"

namespace axial::evaluate {

struct SceneAlignment {
  Similarity similarity;
  std::size_t images = 0;           // that took part
  double rms = 0, largest = 0;      // distances of the centres that are left
  std::optional<double> turn = {};  // largest angle between the rotations [rad], between scenes
};

// Pairs of calibrated images of two scenes, as indices.
struct ImagePairs {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  bool by_name = true;
};

// Pairs images whose paths have the same file name. Of several candidates, the one with the most
// equal folders before the file name is taken, and none if that is not one image. If fewer than
// three images pair, images are paired by their order, if both scenes have the same number of
// calibrated images. Error for neither.
ImagePairs pair_images(const Scene& scene, const Scene& reference);

// Returns the similarity that maps the camera centres of `scene` to those of `reference`. Without
// `with_scale` the scale is 1. Error as for fit_similarity.
SceneAlignment align_scenes(const Scene& scene, const Scene& reference, const ImagePairs& images,
                            bool with_scale);

// Returns the similarity that maps the camera centres of the images to `positions`. Both have the
// same number of elements. Error as above.
SceneAlignment align_to_positions(const Scene& scene, std::span<const std::size_t> images,
                                  std::span<const Eigen::Vector3d> positions, bool with_scale);

// Returns the calibrated images whose path ends in `name`, in whole components.
std::vector<std::size_t> images_named(const Scene& scene, const std::string& name);

}  // namespace axial::evaluate
