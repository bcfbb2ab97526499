// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "geometry/posed_camera.h"
#include "scene/mesh.h"

namespace axial::map {

using geometry::PosedCamera;

// The median width [m] of a photograph's pixel on the mesh, to choose the pixel of a map. The
// places are `places` points that are spread evenly over the area of the mesh. At each place the
// photograph counts that shows the place best: with the largest product of the area of a piece of
// surface in the image and the squared cosine of the angle between its normal and the path of
// light, which is the measure of TextureMesh. The width is the square root of the area on the
// surface that a pixel shows, as the exact camera projects it. Photographs that other parts of the
// mesh hide from the place count, too. Error if no place is in a photograph that faces it.
double median_pixel_width(const Mesh& mesh, std::span<const PosedCamera> photos, int places = 2000);

// The memory [bytes] of median_pixel_width().
std::uint64_t bytes_of_pixel_width(const Mesh& mesh);

// `width` rounded to two significant digits. Precondition: `width` is above 0.
double rounded_width(double width);

}  // namespace axial::map
