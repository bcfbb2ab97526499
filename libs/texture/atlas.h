// SPDX-License-Identifier: GPL-3.0-or-later
// The atlas: textures that contain, for each chart, the part of a photograph that shows the chart.
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

// The textures, and the places of the charts in the textures. Positions are pixels (x, y) with
// centres at integers, as in TexturedMesh.
struct Atlas {
  std::vector<cv::Mat3b> textures;  // B G R
  // One per chart: the part of the photograph. It is Chart::rect. If Chart::rect is larger than a
  // texture, the part has a wider border.
  std::vector<cv::Rect> parts;
  std::vector<cv::Rect> rects;            // one per chart: the place of the part in its texture
  std::vector<std::uint32_t> texture_of;  // one per chart: the index of its texture
  std::vector<Eigen::Vector2f> uv;        // one per node: its position in its chart's texture [px]
  Eigen::Vector2f empty_uv{0.5f, 0.5f};   // a position in texture 0 that has the empty colour [px]
  std::size_t scaled_down = 0;            // charts that were larger than a texture
};

// Finds a place for each chart, and fills all textures with the colour `empty` (R G B). The upper
// left 5 x 5 pixels of texture 0 stay free of charts and keep the colour `empty` (Atlas::empty_uv).
// A chart that is larger than a texture is scaled down. In the texture, the border around the faces
// of each chart has at least kBorder pixels (charts.h). Throws an Error if pack() refuses `options`
// (packing.h), or if the textures need more memory than `budget` allows.
Atlas lay_out(const Charts& charts, const PackingOptions& options, const Rgb& empty,
              const Budget& budget = {});

// The memory [bytes] of textures of these sizes.
std::uint64_t bytes_of_textures(std::span<const cv::Size> sizes);

// Copies, for each chart, the part of the chart's photograph (Atlas::parts) into the chart's place
// in the textures. A part that is larger than its place is scaled down. `views`: the number of
// views, whose photographs `images` returns. Only views with charts are asked for. `sharpness`
// (>= 0): the amount of an unsharp mask, 0 for none. The mask replaces a photograph T by
// (1 + sharpness) T - sharpness (G * T), where * is convolution and G a Gaussian with a standard
// deviation of 1.5 px. Where a part extends beyond the photograph, it repeats the photograph's
// border pixels. `in_flight`: the largest number of photographs in work at the same time. 0, and
// values above the number of threads, count as the number of threads.
void paint(Atlas& atlas, const Charts& charts, std::size_t views, const ImageSource& images,
           double sharpness, std::size_t in_flight = 0);

// The memory [bytes] of a photograph of `pixels` pixels in work in paint(), besides that of
// `images`.
std::uint64_t bytes_to_paint(std::uint64_t pixels);

}  // namespace axial::texture
