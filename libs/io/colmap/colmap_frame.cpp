// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap_frame.h"

#include <vector>

namespace axial::io {

LocalFrame enter_local_frame(ColmapModel& model) {
  std::vector<Eigen::Vector3d> centres, points;
  for (const ColmapImage& image : model.images) centres.push_back(image.pose.centre);
  for (const ColmapPoint3D& point : model.points) points.push_back(point.position);
  const LocalFrame frame = frame_of(centres, points);
  enter(frame, model);
  return frame;
}

void enter(const LocalFrame& frame, ColmapModel& model) {
  leave({-frame.origin}, model);
}

void leave(const LocalFrame& frame, ColmapModel& model) {
  if (frame.is_world()) return;
  for (ColmapImage& image : model.images) image.pose.centre = frame.to_world(image.pose.centre);
  for (ColmapPoint3D& point : model.points) point.position = frame.to_world(point.position);
}

}  // namespace axial::io
