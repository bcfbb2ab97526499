// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/alignment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "scene/moved_scene.h"

namespace axial::evaluate {
namespace {

Eigen::Matrix3Xd columns(std::span<const Eigen::Vector3d> points) {
  Eigen::Matrix3Xd matrix(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    matrix.col(static_cast<Eigen::Index>(i)) = points[i];
  return matrix;
}

void check_spread(const Eigen::Matrix3Xd& points, const char* which) {
  if (!points.allFinite()) fail("a {} position is not finite", which);
  if (!(relative_width(points) > kLineWidth))
    fail("the {} {} positions lie on one line: they do not determine a similarity", points.cols(),
         which);
}

}  // namespace

RobustSimilarity fit_positions(std::span<const Eigen::Vector3d> source,
                               std::span<const Eigen::Vector3d> target, bool with_scale,
                               std::span<const std::string> names) {
  if (source.size() != target.size())
    fail("{} positions cannot be fitted to {}", source.size(), target.size());
  if (source.size() < 3)
    fail("{} common positions are too few for a similarity, at least 3 are needed", source.size());
  const Eigen::Matrix3Xd from = columns(source);
  const Eigen::Matrix3Xd to = columns(target);
  check_spread(from, "estimated");
  check_spread(to, "reference");
  if (const MirroredFit mirrored = mirrored_fit(from, to, with_scale); mirrored.better)
    fail("{}", mirrored_line(mirrored));
  RobustSimilarity fit = robust_similarity(from, to, with_scale);
  if (const auto point = fit.off_line)
    fail("{}", off_line_sentence(
                   fit, names.empty() ? fmt::format("number {}", *point + 1) : names[*point]));
  return fit;
}

Similarity fit_similarity(std::span<const Eigen::Vector3d> source,
                          std::span<const Eigen::Vector3d> target, bool with_scale) {
  return fit_positions(source, target, with_scale).similarity;
}

CentreAlignment align_centres(const io::ColmapModel& model, const io::ColmapModel& reference) {
  std::map<std::string, Pose> poses;
  for (const io::ColmapImage& image : reference.images) poses[image.name] = image.pose;
  CentreAlignment result;
  std::vector<Eigen::Vector3d> source, target;
  std::vector<Eigen::Matrix3d> apart;  // rotations from the model's world to the reference's
  for (const io::ColmapImage& image : model.images) {
    const auto found = poses.find(image.name);
    if (found == poses.end()) continue;
    result.names.push_back(image.name);
    source.push_back(image.pose.centre);
    target.push_back(found->second.centre);
    apart.emplace_back(found->second.rotation.transpose() * image.pose.rotation);
  }
  if (source.size() < 3)
    fail("the models have {} images with the same name, a similarity needs at least 3",
         source.size());
  RobustSimilarity fit = fit_positions(source, target, true, result.names);
  result.similarity = fit.similarity;
  result.outliers = outlier_lines(fit, result.names);
  double sum = 0, sum_of_fitting = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const double squared = (result.similarity(source[i]) - target[i]).squaredNorm();
    result.residuals.push_back(std::sqrt(squared));
    sum += squared;
    const Eigen::Matrix3d turn = apart[i] * result.similarity.rotation.transpose();
    result.turns.push_back(Eigen::AngleAxisd(turn).angle());
    if (std::ranges::binary_search(fit.outliers, i)) continue;
    sum_of_fitting += squared;
    result.largest = std::max(result.largest, result.residuals.back());
    result.largest_turn = std::max(result.largest_turn, result.turns.back());
  }
  result.rms = std::sqrt(sum / static_cast<double>(source.size()));
  result.rms_of_fitting =
      std::sqrt(sum_of_fitting / static_cast<double>(source.size() - fit.outliers.size()));
  return result;
}

std::vector<std::string> not_matched(const CentreAlignment& alignment,
                                     const io::ColmapModel& reference) {
  const std::set<std::string> matched(alignment.names.begin(), alignment.names.end());
  std::size_t count = 0;
  const std::string* first = nullptr;
  for (const io::ColmapImage& image : reference.images) {
    if (matched.contains(image.name)) continue;
    if (count++ == 0) first = &image.name;
  }
  if (count == 0) return {};
  return {fmt::format("{} of {} centres belong to no image of the model and are ignored, first {}",
                      count, reference.images.size(), *first)};
}

Similarity between_worlds(const Similarity& similarity, const LocalFrame& from,
                          const LocalFrame& to) {
  return FrameMove{similarity, from, to}.between_worlds();
}

void apply(const Similarity& similarity, io::ColmapModel& model) {
  for (io::ColmapImage& image : model.images) image.pose = similarity(image.pose);
  for (io::ColmapPoint3D& point : model.points) point.position = similarity(point.position);
}

void apply(const Similarity& similarity, PointCloud& cloud) {
  for (Eigen::Vector3f& x : cloud.positions) x = similarity(x.cast<double>()).cast<float>();
  for (Eigen::Vector3f& n : cloud.normals)
    n = (similarity.rotation * n.cast<double>()).cast<float>();
}

void apply(const Similarity& similarity, Mesh& mesh) {
  for (Eigen::Vector3f& x : mesh.vertices) x = similarity(x.cast<double>()).cast<float>();
}

std::string matrix_text(const Similarity& similarity) {
  const Eigen::Matrix4d m = similarity.matrix();
  std::string text;
  for (int row = 0; row < 4; ++row)
    text += fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}\n", m(row, 0), m(row, 1), m(row, 2),
                        m(row, 3));
  return text;
}

}  // namespace axial::evaluate
