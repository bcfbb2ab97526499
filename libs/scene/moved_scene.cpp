// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/moved_scene.h"

namespace axial {

FrameMove FrameMove::ending_in(const LocalFrame& frame) const {
  FrameMove result{similarity, from, frame};
  result.similarity.translation += to.origin - frame.origin;
  return result;
}

Similarity FrameMove::between_worlds() const {
  Similarity worlds = similarity;
  worlds.translation = to.to_world(similarity(-from.origin));
  return worlds;
}

FrameMove move_in(const LocalFrame& frame, const Similarity& worlds) {
  FrameMove result{worlds, frame, frame};
  result.similarity.translation = frame.to_local(worlds(frame.origin));
  return result;
}

void apply(const Similarity& similarity, Scene& scene) {
  const auto scale = static_cast<float>(similarity.scale);
  for (SceneImage& image : scene.images) {
    if (!image.calibrated) continue;
    image.pose = similarity(image.pose);
    for (float* depth : {&image.min_depth, &image.average_depth, &image.max_depth}) *depth *= scale;
  }
  for (SparsePoint& point : scene.points)
    point.position = similarity(point.position.cast<double>()).cast<float>();
  for (Eigen::Vector3f& normal : scene.point_normals)
    normal = (similarity.rotation * normal.cast<double>()).cast<float>();
  if (!scene.region) return;
  scene.region->rotation = scene.region->rotation * similarity.rotation.transpose();
  scene.region->centre = similarity(scene.region->centre);
  scene.region->half_extent *= similarity.scale;
}

}  // namespace axial
