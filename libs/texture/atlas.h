// SPDX-License-Identifier: GPL-3.0-or-later
// The atlas: the textures, into which the parts of the photographs that belong to charts are
// packed.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "scene/mesh.h"
#include "texture/charts.h"
#include "texture/packing.h"

namespace axial::texture {

struct Atlas {
  std::vector<cv::Mat3b> textures;
  std::vector<cv::Rect> rects;            // one per chart: the place of Chart::rect
  std::vector<std::uint32_t> texture_of;  // one per chart
  std::vector<Eigen::Vector2f> uv;        // one per node [px], as in TexturedMesh
  Eigen::Vector2f empty_uv{0.5f, 0.5f};   // in texture 0: within pixels of the empty colour
  std::size_t scaled_down = 0;            // charts that were larger than a texture
};

// Finds a place for each chart, and fills all textures with the colour `empty`. No chart is placed
// in the 5 x 5 pixels of the upper left corner of texture 0, so that these pixels keep this colour
// (Atlas::empty_uv). Errors as for pack().
Atlas lay_out(const Charts& charts, const PackingOptions& options, const Rgb& empty);

// Copies the part Chart::rect of the photograph of each chart into the chart's place in the
// textures. Where the place is smaller, the part is scaled down. `views`: the number of views,
// whose photographs `images` returns. `sharpness`: the amount of an unsharp mask, 0 for none. The
// mask replaces a photograph T by (1 + sharpness) T - sharpness (G * T), where * is convolution and
// G a Gaussian with a standard deviation of 1.5 px. Where a part extends beyond the photograph, it
// repeats the photograph's border pixels.
void paint(Atlas& atlas, const Charts& charts, std::size_t views, const ImageSource& images,
           double sharpness);

}  // namespace axial::texture
