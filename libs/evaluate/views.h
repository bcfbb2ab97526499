// SPDX-License-Identifier: GPL-3.0-or-later
// The cameras of the photographs, and the parts of the truth that they can have seen.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "axial/scene.h"
#include "geometry/posed_camera.h"
#include "geometry/surface.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "scene/camera_model.h"

namespace axial::evaluate {

// The camera of one photograph, with its port, if there is one.
struct View : geometry::PosedCamera {
  std::string name = {};  // of the image in the model
};

// Returns one view for each image of the model, in the order of the images, with the ports of
// `housing`. If `housing` is null, the views have no ports. Error if there are no images, if an
// image refers to a camera that the model does not have, if a lens is neither a pinhole nor a lens
// with a known distortion (lens_distortion), if the distortion of a lens mirrors the image, or as
// for Housing::port_at.
std::vector<View> views_of_model(const io::ColmapModel& model, const io::Housing* housing);

// Returns, for each point [world], the number of views that see the point. A view sees a point
// under two conditions. First, the point is projected into the image rectangle of the view, which
// includes the whole area of the outermost pixels. Second, `surface` [world] does not cross the
// straight line from the point to the camera. The line ends at the camera centre, or, behind a
// port, where the ray of the point's image crosses the outer face of the glass. The orientation of
// the surface does not matter.
std::vector<std::uint32_t> count_views(std::span<const Eigen::Vector3f> points,
                                       std::span<const View> views,
                                       const geometry::Surface& surface);

// Returns, for each point [world], the number of views into whose image rectangle the point is
// projected. Occlusion is not tested, so points slightly below the surface count like points on it.
std::vector<std::uint32_t> count_frames(std::span<const Eigen::Vector3f> points,
                                        std::span<const View> views);

// Returns, for each point [world], the width of a pixel at the point [m], as the mean over the
// views that see the point (count_views). The width is 0 if no view sees the point. In one view the
// width is the motion of the point across its ray that moves the image by one pixel (geometric mean
// over the directions).
std::vector<float> pixel_widths(std::span<const Eigen::Vector3f> points,
                                std::span<const View> views, const geometry::Surface& surface);

}  // namespace axial::evaluate
