// SPDX-License-Identifier: GPL-3.0-or-later
// The atlas: textures that contain, for each chart, the part of a photograph that shows the chart.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "axial/base.h"
#include "scene/mesh.h"
#include "texture/atlas/charts.h"
#include "texture/atlas/packing.h"

namespace axial::texture {

// The charts are divided into tiles, each of which has textures of its own. Only the textures of
// one tile are in memory at the same time. By default there is one tile.
struct ChartTiles {
  std::size_t count = 1;
  std::vector<std::uint32_t> of_chart;  // one per chart: index of its tile. Empty for one tile.

  std::size_t of(std::size_t chart) const { return of_chart.empty() ? 0 : of_chart[chart]; }
};

// The textures, and the places of the charts in the textures. Positions are pixels (x, y) with
// centres at integers, as in TexturedMesh.
//
// Atlas::uv are positions in the textures of one piece: the textures that all charts would have
// together. The colours of a chart are computed at these positions. Their rounded digits depend on
// the place of the chart, and therefore they are the same for any tiles. Atlas::corners leads from
// these positions to the textures of the tiles.
struct Atlas {
  std::vector<cv::Mat3b> textures;  // B G R, of the tile in work
  std::size_t tile = 0;             // the tile in work: that of the last begin_tile()
  ChartTiles tiles;
  std::vector<std::vector<cv::Size>> sizes;  // of the textures of each tile [px]
  // One per chart: the part of the photograph. It is Chart::rect. If Chart::rect is larger than a
  // texture, the part has a wider border.
  std::vector<cv::Rect> parts;
  std::vector<cv::Rect> rects;            // one per chart: the place of the part in its texture
  std::vector<std::uint32_t> texture_of;  // one per chart: the index of its texture in its tile
  // One per chart: the upper left pixel of its place in the textures of one piece. With one tile it
  // is that of `rects`.
  std::vector<cv::Point> corners;
  std::vector<Eigen::Vector2f> uv;       // one per node: its position in one piece [px]
  Eigen::Vector2f empty_uv{0.5f, 0.5f};  // a position in texture 0 that has the empty colour [px]
  std::size_t scaled_down = 0;           // charts that were larger than a texture

  bool in_work(std::size_t chart) const { return tiles.of(chart) == tile; }

  // The pixels of a chart of the tile in work.
  cv::Mat3b pixels(std::size_t chart) const { return textures[texture_of[chart]](rects[chart]); }

  // The position of a node, or a position between nodes of a chart, relative to the centre of the
  // chart's upper left pixel. `at`: in one piece.
  Eigen::Vector2f in_chart(const Eigen::Vector2f& at, std::size_t chart) const {
    return at - Eigen::Vector2f(static_cast<float>(corners[chart].x),
                                static_cast<float>(corners[chart].y));
  }

  // The position of a node in its chart's texture.
  Eigen::Vector2f in_texture(std::uint32_t node, std::size_t chart) const {
    return in_chart(uv[node], chart) +
           Eigen::Vector2f(static_cast<float>(rects[chart].x), static_cast<float>(rects[chart].y));
  }
};

// Finds a place for each chart. The upper left 5 x 5 pixels of texture 0 of each tile stay free of
// charts. A chart that is larger than a texture is scaled down. In the texture, the border around
// the faces of each chart has at least kBorder pixels (charts.h). No tile is in work yet. Throws an
// Error if pack() refuses `options` (packing.h).
Atlas plan_atlas(const Charts& charts, ChartTiles tiles, const PackingOptions& options);

// Makes the textures of `tile`, in place of those of another tile, and fills them with the colour
// `empty` (R G B). Throws an Error if the textures need more memory than `budget` allows.
void begin_tile(Atlas& atlas, std::size_t tile, const Rgb& empty, const MemoryBudget& budget);

// plan_atlas() and begin_tile() for one tile.
Atlas lay_out(const Charts& charts, const PackingOptions& options, const Rgb& empty,
              const MemoryBudget& budget = {});

// The memory [bytes] of textures of these sizes.
std::uint64_t bytes_of_textures(std::span<const cv::Size> sizes);

// Copies, for each chart of the tile in work, the part of the chart's photograph (Atlas::parts)
// into the chart's place in the textures. A part that is larger than its place is scaled down.
// `views`: the number of views, whose photographs `images` returns. Only views with charts are
// asked for. `sharpness`
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
