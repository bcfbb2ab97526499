// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/atlas.h"

#include <opencv2/imgproc.hpp>

#include "base/parallel.h"

namespace axial::texture {
namespace {

constexpr int kEmptySide = 5;  // [px]

cv::Mat3b sharpened(const cv::Mat3b& image, double amount) {
  if (amount == 0) return image;
  cv::Mat3b smooth, result;
  cv::GaussianBlur(image, smooth, {}, 1.5);
  cv::addWeighted(image, 1 + amount, smooth, -amount, 0, result);
  return result;
}

// The part of the image in `rect`, which may extend beyond it.
cv::Mat3b part_of(const cv::Mat3b& image, const cv::Rect& rect) {
  const cv::Rect inside = rect & cv::Rect({}, image.size());
  if (inside == rect) return image(rect);
  cv::Mat3b result;
  cv::copyMakeBorder(image(inside), result, inside.y - rect.y, rect.br().y - inside.br().y,
                     inside.x - rect.x, rect.br().x - inside.br().x,
                     cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
  return result;
}

void copy_part(const cv::Mat3b& image, const cv::Rect& rect, cv::Mat3b target) {
  const cv::Mat3b part = part_of(image, rect);
  if (part.size() == target.size())
    part.copyTo(target);
  else
    cv::resize(part, target, target.size(), 0, 0, cv::INTER_AREA);
}

void place_nodes(const Charts& charts, Atlas& atlas) {
  atlas.uv.resize(charts.nodes.size());
  for (std::size_t n = 0; n < charts.nodes.size(); ++n) {
    const Node& node = charts.nodes[n];
    const cv::Rect &from = charts.charts[node.chart].rect, &to = atlas.rects[node.chart];
    const auto moved = [](float x, int begin, int length, int new_begin, int new_length) {
      const double scale = static_cast<double>(new_length) / length;
      return static_cast<float>((x + 0.5 - begin) * scale - 0.5 + new_begin);
    };
    atlas.uv[n] = {moved(node.pixel.x(), from.x, from.width, to.x, to.width),
                   moved(node.pixel.y(), from.y, from.height, to.y, to.height)};
  }
}

}  // namespace

Atlas lay_out(const Charts& charts, const PackingOptions& options, const Rgb& empty) {
  std::vector<cv::Size> sizes{{kEmptySide, kEmptySide}};
  for (const Chart& chart : charts.charts) sizes.push_back(chart.rect.size());
  const Packing packing = pack(sizes, options);
  Atlas atlas;
  atlas.scaled_down = packing.scaled_down;
  for (std::size_t c = 0; c < charts.charts.size(); ++c) {
    const Place& place = packing.places[c + 1];
    atlas.rects.emplace_back(place.corner, size_at(place, charts.charts[c].rect.size()));
    atlas.texture_of.push_back(place.texture);
  }
  for (const cv::Size& size : packing.sizes)
    atlas.textures.emplace_back(size, cv::Vec3b(empty[2], empty[1], empty[0]));
  place_nodes(charts, atlas);
  return atlas;
}

void paint(Atlas& atlas, const Charts& charts, std::size_t views, const ImageSource& images,
           double sharpness) {
  std::vector<std::vector<std::uint32_t>> charts_of(views);
  for (std::uint32_t c = 0; c < charts.charts.size(); ++c)
    charts_of[charts.charts[c].view].push_back(c);
  for_each_in_flight(views, thread_count(), [&](std::size_t v) {
    if (charts_of[v].empty()) return;
    const cv::Mat3b image = sharpened(images(v).color, sharpness);
    for (const std::uint32_t c : charts_of[v])
      copy_part(image, charts.charts[c].rect, atlas.textures[atlas.texture_of[c]](atlas.rects[c]));
  });
}

}  // namespace axial::texture
