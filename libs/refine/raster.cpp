// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace axial::refine {
namespace {

constexpr int kBandRows = 64;  // rows that one thread draws

// Edges belong to both faces: at this tolerance rounding leaves no gap between them.
constexpr double kEdgeTolerance = 1e-6;

// The rows of pixel centres from `top` to `bottom` that the face may cover.
struct Rows {
  int top, bottom;
};

Rows rows_of(const VertexImage& a, const VertexImage& b, const VertexImage& c) {
  const auto [low, high] = std::minmax({a.y, b.y, c.y});
  return {static_cast<int>(std::ceil(low)), static_cast<int>(std::floor(high))};
}

void draw_face(const VertexImage& a, const VertexImage& b, const VertexImage& c, std::uint32_t face,
               Rows rows, Raster& raster) {
  const double abx = b.x - a.x, aby = b.y - a.y, acx = c.x - a.x, acy = c.y - a.y;
  const double twice = abx * acy - aby * acx;
  if (twice == 0) return;
  const auto [low, high] = std::minmax({a.x, b.x, c.x});
  const int left = std::max(0, static_cast<int>(std::ceil(low)));
  const int right = std::min(raster.depth.cols - 1, static_cast<int>(std::floor(high)));
  for (int y = rows.top; y <= rows.bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const double px = static_cast<double>(x) - a.x, py = static_cast<double>(y) - a.y;
      const double b1 = (px * acy - py * acx) / twice, b2 = (abx * py - aby * px) / twice;
      if (b1 < -kEdgeTolerance || b2 < -kEdgeTolerance || b1 + b2 > 1 + kEdgeTolerance) continue;
      const auto depth =
          static_cast<float>(a.depth + b1 * (b.depth - a.depth) + b2 * (c.depth - a.depth));
      if (depth < raster.depth(y, x)) {
        raster.depth(y, x) = depth;
        raster.face_bits(y, x) = static_cast<std::int32_t>(face);
      }
    }
}

// The faces that reach into each band of rows, in ascending order.
std::vector<std::vector<std::uint32_t>> faces_of_bands(const Mesh& mesh,
                                                       std::span<const VertexImage> images,
                                                       int height) {
  const int bands = (height + kBandRows - 1) / kBandRows;
  std::vector<std::vector<std::uint32_t>> lists(static_cast<std::size_t>(bands));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    if (!images[a].visible() || !images[b].visible() || !images[c].visible()) continue;
    const Rows rows = rows_of(images[a], images[b], images[c]);
    if (rows.bottom < 0 || rows.top >= height || rows.top > rows.bottom) continue;
    const int last = std::min(rows.bottom, height - 1) / kBandRows;
    for (int band = std::max(rows.top, 0) / kBandRows; band <= last; ++band)
      lists[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(f));
  }
  return lists;
}

}  // namespace

Raster draw(const Mesh& mesh, std::span<const VertexImage> images, cv::Size size) {
  Raster raster{cv::Mat1f(size, std::numeric_limits<float>::infinity()),
                cv::Mat_<std::int32_t>(size, static_cast<std::int32_t>(kNoFace))};
  const auto bands = faces_of_bands(mesh, images, size.height);
  parallel_for(bands.size(), [&](std::size_t band) {
    const int first = static_cast<int>(band) * kBandRows;
    const int last = std::min(first + kBandRows, size.height) - 1;
    for (const std::uint32_t f : bands[band]) {
      const auto& [a, b, c] = mesh.faces[f];
      const Rows rows = rows_of(images[a], images[b], images[c]);
      draw_face(images[a], images[b], images[c], f,
                {std::max(rows.top, first), std::min(rows.bottom, last)}, raster);
    }
  });
  return raster;
}

Barycentric barycentric(const VertexImage& a, const VertexImage& b, const VertexImage& c, float x,
                        float y) {
  const float abx = b.x - a.x, aby = b.y - a.y, acx = c.x - a.x, acy = c.y - a.y;
  const float inverse = 1 / (abx * acy - aby * acx);
  const float px = x - a.x, py = y - a.y;
  return {(px * acy - py * acx) * inverse, (abx * py - aby * px) * inverse};
}

geometry::Lists<> pixels_of_faces(const Raster& raster, std::size_t faces) {
  return geometry::lists_of(faces, [&](const auto& add) {
    std::uint32_t pixel = 0;
    for (const std::int32_t bits : raster.face_bits) {
      if (const auto f = static_cast<std::uint32_t>(bits); f != kNoFace) add(f, pixel);
      ++pixel;
    }
  });
}

}  // namespace axial::refine
