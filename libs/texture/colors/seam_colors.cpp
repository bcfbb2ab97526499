// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/colors/seam_colors.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "scene/bilinear.h"

namespace axial::texture {
namespace {

std::uint32_t samples_of(const Atlas& atlas, const Seam& seam) {
  const float a = (atlas.uv[seam.a[1]] - atlas.uv[seam.a[0]]).norm();
  const float b = (atlas.uv[seam.b[1]] - atlas.uv[seam.b[0]]).norm();
  return std::max(2u, static_cast<std::uint32_t>(std::ceil(2 * std::max(a, b))));
}

}  // namespace

std::uint64_t bytes_of_seams(const Atlas& atlas, std::span<const Seam> seams) {
  std::uint64_t samples = 0;
  for (const Seam& seam : seams) samples += samples_of(atlas, seam);
  return seams.size() * sizeof(std::uint32_t) + samples * sizeof(Eigen::Vector3f);
}

SeamColors seam_samples(const Atlas& atlas, std::span<const Seam> seams) {
  SeamColors result;
  result.begin.reserve(seams.size() + 1);
  result.begin.push_back(0);
  for (const Seam& seam : seams)
    result.begin.push_back(result.begin.back() + samples_of(atlas, seam));
  result.differences.assign(result.begin.back(), Eigen::Vector3f::Zero());
  return result;
}

void add_seam_colors(SeamColors& colors, const Atlas& atlas, const Charts& charts,
                     std::span<const Seam> seams) {
  const auto add = [&](std::size_t s, const std::array<std::uint32_t, 2>& nodes, float sign) {
    const std::uint32_t chart = charts.nodes[nodes[0]].chart;
    if (!atlas.in_work(chart)) return;
    const cv::Mat3b pixels = atlas.pixels(chart);
    const std::uint32_t begin = colors.begin[s], n = colors.begin[s + 1] - begin;
    for (std::uint32_t k = 0; k < n; ++k) {
      const float t = (static_cast<float>(k) + 0.5f) / static_cast<float>(n);
      const Eigen::Vector2f at = (1 - t) * atlas.uv[nodes[0]] + t * atlas.uv[nodes[1]];
      colors.differences[begin + k] += sign * bilinear(pixels, atlas.in_chart(at, chart));
    }
  };
  parallel_for(
      seams.size(),
      [&](std::size_t s) {
        add(s, seams[s].a, -1);
        add(s, seams[s].b, 1);
      },
      kPointGrain);
}

}  // namespace axial::texture
