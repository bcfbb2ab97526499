// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/scene_alignment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "base/error.h"
#include "evaluate/alignment.h"

namespace axial::evaluate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFewest = 3;  // positions that determine a similarity

std::vector<std::string> components_from_the_end(const std::string& path) {
  std::vector<std::string> components;
  for (const fs::path& part : fs::path(path).lexically_normal())
    components.push_back(part.string());
  std::ranges::reverse(components);
  return components;
}

// The number of equal components at the ends of two paths.
std::size_t common_end(const std::string& a, const std::string& b) {
  const auto x = components_from_the_end(a), y = components_from_the_end(b);
  const auto differ = std::ranges::mismatch(x, y);
  return static_cast<std::size_t>(differ.in1 - x.begin());
}

std::vector<std::size_t> calibrated(const Scene& scene) {
  std::vector<std::size_t> images;
  for (std::size_t i = 0; i < scene.images.size(); ++i)
    if (scene.images[i].calibrated) images.push_back(i);
  return images;
}

std::map<std::string, std::vector<std::size_t>> by_file_name(const Scene& scene) {
  std::map<std::string, std::vector<std::size_t>> images;
  for (const std::size_t i : calibrated(scene))
    images[fs::path(scene.images[i].path).filename().string()].push_back(i);
  return images;
}

// The one image of `candidates` whose path has the longest end in common; nothing if two have it.
std::optional<std::size_t> most_alike(const std::string& path, const Scene& scene,
                                      const std::vector<std::size_t>& candidates) {
  std::optional<std::size_t> best;
  std::size_t length = 0;
  for (const std::size_t candidate : candidates) {
    const std::size_t common = common_end(path, scene.images[candidate].path);
    if (common < length) continue;
    best = common > length ? std::optional(candidate) : std::nullopt;
    length = common;
  }
  return best;
}

std::vector<std::pair<std::size_t, std::size_t>> pairs_by_name(const Scene& scene,
                                                               const Scene& reference) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const auto ours = by_file_name(scene), theirs = by_file_name(reference);
  for (const auto& [name, images] : ours) {
    const auto found = theirs.find(name);
    if (found == theirs.end()) continue;
    for (const std::size_t i : images) {
      const auto j = most_alike(scene.images[i].path, reference, found->second);
      if (j && most_alike(reference.images[*j].path, scene, images) == i) pairs.emplace_back(i, *j);
    }
  }
  std::ranges::sort(pairs);
  return pairs;
}

}  // namespace

ImagePairs pair_images(const Scene& scene, const Scene& reference) {
  ImagePairs result{pairs_by_name(scene, reference), true};
  if (result.pairs.size() >= kFewest) return result;
  const auto ours = calibrated(scene), theirs = calibrated(reference);
  if (ours.size() != theirs.size())
    fail("{} of its images have the name of an image of the scene, and it has {} images, not {}",
         result.pairs.size(), theirs.size(), ours.size());
  result = {{}, false};
  for (std::size_t k = 0; k < ours.size(); ++k) result.pairs.emplace_back(ours[k], theirs[k]);
  return result;
}

SceneAlignment align_to_positions(const Scene& scene, std::span<const std::size_t> images,
                                  std::span<const Eigen::Vector3d> positions, bool with_scale) {
  std::vector<Eigen::Vector3d> centres;
  for (const std::size_t i : images) centres.push_back(scene.images[i].pose.centre);
  std::vector<std::string> names;
  for (const std::size_t i : images) names.push_back(scene.images[i].path);
  const RobustSimilarity fit = fit_positions(centres, positions, with_scale, names);
  SceneAlignment result;
  result.similarity = fit.similarity;
  result.images = images.size() - fit.outliers.size();
  result.rms = fit.rms;
  for (std::size_t k = 0; k < centres.size(); ++k)
    if (!std::ranges::binary_search(fit.outliers, k))
      result.largest = std::max(result.largest, fit.distances[k]);
  result.outliers = outlier_lines(fit, names);
  return result;
}

std::optional<std::string> may_be_mirrored(const Scene& scene, std::span<const std::size_t> images,
                                           std::span<const Eigen::Vector3d> positions,
                                           bool with_scale, const SceneAlignment& alignment) {
  constexpr double kUp = 0.7071;  // sine of 45 degrees
  // Cameras that are hardly turned are in the frame of the positions already.
  if (Eigen::AngleAxisd(alignment.similarity.rotation).angle() < 0.1) return {};
  Eigen::Matrix3Xd from(3, images.size()), to(3, images.size());
  for (std::size_t k = 0; k < images.size(); ++k) {
    const Pose& pose = scene.images[images[k]].pose;
    const double up = alignment.similarity(pose).rotation(2, 2);  // of the optical axis
    if (!(up > kUp)) return {};
    from.col(static_cast<Eigen::Index>(k)) = pose.centre;
    to.col(static_cast<Eigen::Index>(k)) = positions[k];
  }
  if (!mirrored_fit(from, to, with_scale).alike) return {};
  return fmt::format(
      "all cameras look up after the alignment, and the positions fit the mirror image of the "
      "cameras "
      "as well, because they are nearly on a plane. If the cameras looked down, {}",
      kCausesOfMirror);
}

SceneAlignment align_scenes(const Scene& scene, const Scene& reference, const ImagePairs& images,
                            bool with_scale) {
  std::vector<std::size_t> ours;
  std::vector<Eigen::Vector3d> positions;
  for (const auto& [i, j] : images.pairs) {
    ours.push_back(i);
    positions.push_back(reference.images[j].pose.centre);
  }
  SceneAlignment result = align_to_positions(scene, ours, positions, with_scale);
  double turn = 0;
  for (const auto& [i, j] : images.pairs) {
    const Eigen::Matrix3d moved = result.similarity(scene.images[i].pose).rotation;
    const Eigen::Matrix3d apart = moved * reference.images[j].pose.rotation.transpose();
    turn = std::max(turn, Eigen::AngleAxisd(apart).angle());
  }
  result.turn = turn;
  return result;
}

}  // namespace axial::evaluate
