// SPDX-License-Identifier: GPL-3.0-or-later
// The textures: the charts' parts of the photographs, packed.
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

// Finds places for all charts. The textures have the colour `empty`; a piece of 5 x 5 pixels in the
// corner of the first one keeps it. Errors as for pack().
Atlas lay_out(const Charts& charts, const PackingOptions& options, const Rgb& empty);

// Copies the charts' parts of the photographs into the textures. `sharpness` is the amount of an
// unsharp mask, (1 + sharpness) * T - sharpness * G * T, with a Gaussian G of standard deviation
// 1.5 px. Pixels beyond the image repeat its edge.
void paint(Atlas& atlas, const Charts& charts, std::size_t views, const ImageSource& images,
           double sharpness);

}  // namespace axial::texture
