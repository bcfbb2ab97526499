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
#include "texture/memory.h"
#include "texture/packing.h"

namespace axial::texture {

struct Atlas {
  std::vector<cv::Mat3b> textures;
  // One per chart: the part of the photograph. It is Chart::rect. If Chart::rect is larger than a
  // texture, the part has a wider border.
  std::vector<cv::Rect> parts;
  std::vector<cv::Rect> rects;            // one per chart: the place of the part
  std::vector<std::uint32_t> texture_of;  // one per chart
  std::vector<Eigen::Vector2f> uv;        // one per node [px], as in TexturedMesh
  Eigen::Vector2f empty_uv{0.5f, 0.5f};   // in texture 0: within pixels of the empty colour
  std::size_t scaled_down = 0;            // charts that were larger than a texture
};

// Finds a place for each chart, and fills all textures with the colour `empty`. No chart is placed
// in the 5 x 5 pixels of the upper left corner of texture 0, so that these pixels keep this colour
// (Atlas::empty_uv). A chart that is larger than a texture is scaled down. In the texture, the
// border around the faces of each chart has at least kBorder pixels (charts.h). Errors as for
// pack().
// Error if the textures need more memory than `budget` allows.
Atlas lay_out(const Charts& charts, const PackingOptions& options, const Rgb& empty,
              const Budget& budget = {});

// The memory [bytes] of textures of these sizes.
std::uint64_t bytes_of_textures(std::span<const cv::Size> sizes);

// Copies the part of the photograph of each chart (Atlas::parts) into the chart's place in the
// textures. Where the place is smaller, the part is scaled down. `views`: the number of views,
// whose photographs `images` returns. `sharpness`: the amount of an unsharp mask, 0 for none. The
// mask replaces a photograph T by (1 + sharpness) T - sharpness (G * T), where * is convolution and
// G a Gaussian with a standard deviation of 1.5 px. Where a part extends beyond the photograph, it
// repeats the photograph's border pixels. At most `in_flight` photographs are in work at the same
// time, and at most as many as there are threads (0: as many as there are threads).
void paint(Atlas& atlas, const Charts& charts, std::size_t views, const ImageSource& images,
           double sharpness, std::size_t in_flight = 0);

// The memory [bytes] of a photograph of `pixels` pixels in work in paint(), besides that of
// `images`.
std::uint64_t bytes_to_paint(std::uint64_t pixels);

}  // namespace axial::texture
