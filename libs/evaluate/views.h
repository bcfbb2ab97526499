// SPDX-License-Identifier: GPL-3.0-or-later
// The cameras of the photographs, and the parts of the truth that they can have seen.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "evaluate/surface.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "scene/camera_model.h"
#include "scene/pose.h"

namespace axial::evaluate {

struct View {
  std::string name;
  CameraModel camera;
  Pose pose;
};

// Returns one view for each image of the model, with the ports of `housing` (null: dry). Error if
// there are no images, if a lens is neither a pinhole nor a lens with a known distortion
// (io::lens_distortion), or as for Housing::port_at.
std::vector<View> views_of_model(const io::ColmapModel& model, const io::Housing* housing);

// Returns for each point [world] the number of views that see it. A view sees a point if its image
// lies in the image rectangle and the straight line from the point to the camera centre is free.
// Behind a port the line ends where the ray of that pixel crosses the outer face of the glass. The
// orientation of the surface does not matter.
std::vector<std::uint32_t> count_views(std::span<const Eigen::Vector3f> points,
                                       std::span<const View> views, const Surface& surface);

// Returns for each point the number of views in whose image rectangle it is projected, even if it
// is occluded. This also suits points that are slightly below the surface.
std::vector<std::uint32_t> count_frames(std::span<const Eigen::Vector3f> points,
                                        std::span<const View> views);

// Returns for each point the mean width of a pixel at the point, across the ray [m], over the views
// that see it (count_views); 0 if no view sees it.
std::vector<float> pixel_widths(std::span<const Eigen::Vector3f> points,
                                std::span<const View> views, const Surface& surface);

}  // namespace axial::evaluate
