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

// The fit of the camera centres of a scene to their targets, which are centres of another scene or
// known positions.
struct SceneAlignment {
  Similarity similarity;   // from the scene to the frame of the targets
  std::size_t images = 0;  // number of images used
  // RMS and maximum of the distances between moved centres and their targets, in the unit of the
  // targets.
  double rms = 0, largest = 0;
  // Largest angle [rad] between the rotation of a moved image and the rotation of its partner in
  // the reference. Only align_scenes() sets this angle.
  std::optional<double> turn = {};
  // Lines of text for the targets that do not fit the others (outlier_lines() in
  // scene/robust_similarity.h). They do not count in the fit, in `rms` and in `largest`.
  std::vector<std::string> outliers = {};
};

// Pairs of calibrated images: the index in the scene, then the index in the reference. The pairs
// are in the order of the images in the scene.
struct ImagePairs {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  bool by_name = true;  // rule of pair_images(); true: rule 1, false: rule 2
};

// Pairs the calibrated images (SceneImage::calibrated) of two scenes. The rules are, in this order:
// 1. By name. An image of one scene is a candidate for an image of the other scene if their paths
//    have the same file name. The best candidate has the most equal folders directly before the
//    file name. If two candidates are equally good, there is no best candidate. Two images are a
//    pair if each is the best candidate for the other.
// 2. By order, if rule 1 gives fewer than three pairs. The k-th calibrated image of `scene` and the
//    k-th calibrated image of `reference` are a pair.
// Error if rule 2 is needed and the numbers of calibrated images differ.
ImagePairs pair_images(const Scene& scene, const Scene& reference);

// Fits the similarity that maps the camera centres of `scene` to the camera centres of `reference`.
// `images`: the pairs of images (pair_images). Without `with_scale` the scale is 1. Error as for
// fit_positions() (alignment.h).
SceneAlignment align_scenes(const Scene& scene, const Scene& reference, const ImagePairs& images,
                            bool with_scale);

// Fits the similarity that maps the camera centre of image images[k] of `scene` to positions[k].
// Without `with_scale` the scale is 1. Precondition: the images are calibrated. Error as for
// fit_positions() (alignment.h).
SceneAlignment align_to_positions(const Scene& scene, std::span<const std::size_t> images,
                                  std::span<const Eigen::Vector3d> positions, bool with_scale);

// Warns of positions that may be those of a mirrored frame, although the fit cannot tell, because
// all positions are nearly on a plane: returns a line if the mirror image of the cameras fits as
// well, the alignment turns the cameras, and all moved cameras look up, more than 45 degrees above
// the horizon of the axis z. `alignment`: the result of align_to_positions() for the same
// arguments.
std::optional<std::string> may_be_mirrored(const Scene& scene, std::span<const std::size_t> images,
                                           std::span<const Eigen::Vector3d> positions,
                                           bool with_scale, const SceneAlignment& alignment);

}  // namespace axial::evaluate
