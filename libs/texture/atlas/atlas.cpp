// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/atlas/atlas.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
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

// The part of the photograph for a chart. Where the part is larger than a texture, its border
// grows, so that the border still has kBorder pixels after the part has been scaled down.
cv::Rect part_with_border(const cv::Rect& rect, int largest) {
  const int longest = std::max(rect.width, rect.height);
  if (longest <= largest) return rect;
  // A border of b pixels keeps b * largest / (inner + 2 b) pixels of the texture.
  const int inner = longest - 2 * kBorder, room = largest - 2 * kBorder;
  const int more = (kBorder * inner + room - 1) / room - kBorder;
  return {rect.x - more, rect.y - more, rect.width + 2 * more, rect.height + 2 * more};
}

void copy_part(const cv::Mat3b& image, const cv::Rect& rect, cv::Mat3b target) {
  const cv::Mat3b part = part_of(image, rect);
  if (part.size() == target.size())
    part.copyTo(target);
  else
    cv::resize(part, target, target.size(), 0, 0, cv::INTER_AREA);
}

// Places charts in textures of their own, and adds the sizes of the textures to the atlas. Returns
// the number of charts that are scaled down.
std::size_t place_charts(Atlas& atlas, std::span<const std::uint32_t> charts,
                         const PackingOptions& options) {
  std::vector<cv::Size> sizes{{kEmptySide, kEmptySide}};
  for (const std::uint32_t c : charts) sizes.push_back(atlas.parts[c].size());
  const Packing packing = pack(sizes, options);
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const Place& place = packing.places[i + 1];
    atlas.rects[charts[i]] = {place.corner, size_at(place, sizes[i + 1])};
    atlas.texture_of[charts[i]] = place.texture;
  }
  atlas.sizes.push_back(packing.sizes);
  return packing.scaled_down;
}

void place_nodes(const Charts& charts, Atlas& atlas) {
  atlas.uv.resize(charts.nodes.size());
  for (std::size_t n = 0; n < charts.nodes.size(); ++n) {
    const Node& node = charts.nodes[n];
    const cv::Rect& from = atlas.parts[node.chart];
    const cv::Rect to(atlas.corners[node.chart], atlas.rects[node.chart].size());
    const auto moved = [](float x, int begin, int length, int new_begin, int new_length) {
      const double scale = static_cast<double>(new_length) / length;
      return static_cast<float>((x + 0.5 - begin) * scale - 0.5 + new_begin);
    };
    atlas.uv[n] = {moved(node.pixel.x(), from.x, from.width, to.x, to.width),
                   moved(node.pixel.y(), from.y, from.height, to.y, to.height)};
  }
}

}  // namespace

std::uint64_t bytes_of_textures(std::span<const cv::Size> sizes) {
  std::uint64_t pixels = 0;
  for (const cv::Size& size : sizes)
    pixels += static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height);
  return pixels * sizeof(cv::Vec3b);
}

Atlas plan_atlas(const Charts& charts, ChartTiles tiles, const PackingOptions& options) {
  Atlas atlas;
  atlas.tiles = std::move(tiles);
  std::vector<std::uint32_t> all;
  for (std::uint32_t c = 0; c < charts.charts.size(); ++c) {
    all.push_back(c);
    atlas.parts.push_back(part_with_border(charts.charts[c].rect, largest_side(options)));
  }
  atlas.rects.resize(all.size());
  atlas.texture_of.resize(all.size());
  atlas.scaled_down = place_charts(atlas, all, options);
  for (const cv::Rect& rect : atlas.rects) atlas.corners.push_back(rect.tl());
  place_nodes(charts, atlas);
  if (atlas.tiles.count == 1) return atlas;
  atlas.sizes.clear();
  std::vector<std::vector<std::uint32_t>> of_tiles(atlas.tiles.count);
  for (const std::uint32_t c : all) of_tiles[atlas.tiles.of(c)].push_back(c);
  for (const auto& of_tile : of_tiles) place_charts(atlas, of_tile, options);
  return atlas;
}

void begin_tile(Atlas& atlas, std::size_t tile, const Rgb& empty, const MemoryBudget& budget) {
  atlas.textures.clear();
  atlas.tile = tile;
  const std::vector<cv::Size>& sizes = atlas.sizes[tile];
  budget.require(bytes_of_textures(sizes), fmt::format("painting {} textures", sizes.size()));
  for (const cv::Size& size : sizes)
    atlas.textures.emplace_back(size, cv::Vec3b(empty[2], empty[1], empty[0]));
}

Atlas lay_out(const Charts& charts, const PackingOptions& options, const Rgb& empty,
              const MemoryBudget& budget) {
  Atlas atlas = plan_atlas(charts, {}, options);
  begin_tile(atlas, 0, empty, budget);
  return atlas;
}

std::uint64_t bytes_to_paint(std::uint64_t pixels) {
  // The photograph, smoothed and sharpened, and a part that extends beyond it.
  return 4 * sizeof(cv::Vec3b) * pixels;
}

void paint(Atlas& atlas, const Charts& charts, std::size_t views, const ImageSource& images,
           double sharpness, std::size_t in_flight) {
  std::vector<std::vector<std::uint32_t>> charts_of(views);
  for (std::uint32_t c = 0; c < charts.charts.size(); ++c)
    if (atlas.in_work(c)) charts_of[charts.charts[c].view].push_back(c);
  const std::size_t threads = thread_count();
  const std::size_t at_once = in_flight == 0 ? threads : std::min(in_flight, threads);
  for_each_in_flight(views, at_once, [&](std::size_t v) {
    if (charts_of[v].empty()) return;
    const cv::Mat3b image = sharpened(images(v).color, sharpness);
    for (const std::uint32_t c : charts_of[v]) copy_part(image, atlas.parts[c], atlas.pixels(c));
  });
}

}  // namespace axial::texture
