// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/scaled_views.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/parallel.h"

namespace axial::refine {
namespace {

int scaled_side(int side, double factor) {
  return std::max(1, static_cast<int>(std::lround(side * factor)));
}

float area_of(const VertexImage& a, const VertexImage& b, const VertexImage& c) {
  return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

}  // namespace

ScaledViews::ScaledViews(std::span<const PosedCamera> views, const Pictures& pictures,
                         double factor)
    : views_(views.begin(), views.end()), pictures_(pictures) {
  if (factor == 1) return;
  for (PosedCamera& view : views_)
    if (view.camera.width > 0)
      view.camera = view.camera.resized(scaled_side(view.camera.width, factor),
                                        scaled_side(view.camera.height, factor));
}

cv::Size ScaledViews::size(std::size_t view) const {
  return {views_[view].camera.width, views_[view].camera.height};
}

ScaledViews::Pixels ScaledViews::pixels(std::size_t view) const {
  const Picture picture = pictures_(view);
  Pixels pixels;
  picture.grey.convertTo(pixels.grey, CV_32F);
  pixels.mask = picture.mask;
  if (picture.grey.size() == size(view)) return pixels;
  cv::resize(pixels.grey, pixels.grey, size(view), 0, 0, cv::INTER_AREA);
  if (pixels.mask.empty()) return pixels;
  // A pixel that is partly masked is not used.
  cv::Mat1b usable;
  cv::compare(pixels.mask, 0, usable, cv::CMP_NE);
  cv::resize(usable, usable, size(view), 0, 0, cv::INTER_AREA);
  cv::compare(usable, 255, pixels.mask, cv::CMP_EQ);
  return pixels;
}

Visibility find_visibility(const Mesh& mesh, const Shape& shape, const ScaledViews& views,
                           MeshImages& images) {
  Visibility visibility(mesh.vertices.size(), views.count());
  for (std::size_t i = 0; i < views.count(); ++i) {
    if (!views.used(i)) continue;
    const auto image = images.get(i);
    mark_seen(*image, shape, draw(mesh, *image, views.size(i)), i, visibility);
  }
  return visibility;
}

std::vector<bool> larger_than(double limit, const Mesh& mesh, const ScaledViews& views,
                              const Visibility& visibility, MeshImages& images) {
  std::vector<std::uint8_t> count(mesh.faces.size());
  for (std::size_t i = 0; i < views.count(); ++i) {
    if (!views.used(i)) continue;
    const auto image = images.get(i);
    parallel_for(
        mesh.faces.size(),
        [&](std::size_t f) {
          const auto& [a, b, c] = mesh.faces[f];
          if (count[f] < 2 && visibility.seen(a, i) && visibility.seen(b, i) &&
              visibility.seen(c, i) && area_of((*image)[a], (*image)[b], (*image)[c]) > limit)
            ++count[f];
        },
        kPointGrain);
  }
  std::vector<bool> large(mesh.faces.size());
  for (std::size_t f = 0; f < large.size(); ++f) large[f] = count[f] == 2;
  return large;
}

}  // namespace axial::refine
