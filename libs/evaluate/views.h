// SPDX-License-Identifier: GPL-3.0-or-later
// The cameras that took the pictures, and what they can have seen of the truth.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "evaluate/surface.h"
#include "io/colmap.h"
#include "io/housing.h"
#include "scene/camera_model.h"
#include "scene/pose.h"

namespace axial::evaluate {

struct View {
  std::string name;
  CameraModel camera;
  Pose pose;
};

// One view an image of the model, ports from `housing` (null: dry). Error if there is no image, a
// camera is no pinhole, or an image has no port by Housing::port_at.
std::vector<View> views_of_model(const io::ColmapModel& model, const io::Housing* housing);

// How many views see each point [world]: the point's image lies in the image rectangle, and nothing
// stands on the straight line from it to the camera centre, or, behind a port, to where that
// pixel's light enters the glass. The surface's own orientation does not count.
std::vector<std::uint32_t> count_views(std::span<const Eigen::Vector3f> points,
                                       std::span<const View> views, const Surface& surface);

// In how many views' image rectangles each point's image lies, whatever stands in between: also for
// points that are a little below the surface.
std::vector<std::uint32_t> count_frames(std::span<const Eigen::Vector3f> points,
                                        std::span<const View> views);

// The mean width [m] of a pixel, across the ray, at each point, over the views that see it as
// count_views has it; 0 where none does.
std::vector<float> pixel_widths(std::span<const Eigen::Vector3f> points,
                                std::span<const View> views, const Surface& surface);

}  // namespace axial::evaluate
