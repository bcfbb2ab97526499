// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/atlas/atlas.h"

#include <gtest/gtest.h>

namespace axial::texture {
namespace {

// Charts of one view: each covers the inside of a rectangle of its photograph.
Charts charts_of(const std::vector<cv::Rect>& rects) {
  Charts charts;
  for (std::uint32_t c = 0; c < rects.size(); ++c) {
    charts.charts.push_back({0, rects[c]});
    const cv::Point low = rects[c].tl(), high = rects[c].br();
    for (const int x : {low.x + kBorder, high.x - 1 - kBorder})
      for (const int y : {low.y + kBorder, high.y - 1 - kBorder})
        charts.nodes.push_back({0, c, {static_cast<float>(x), static_cast<float>(y)}});
  }
  return charts;
}

// A photograph whose colour tells the position: blue is x, green is y.
ViewImage ramps(cv::Size size) {
  ViewImage image{cv::Mat3b(size), {}};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      image.color(y, x) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 0};
  return image;
}

// A chart that is scaled down keeps the border of a chart that is not, and the border shows the
// photograph: interpolation and the smaller images of a viewer use these pixels.
TEST(Atlas, TheBorderOfAScaledChartIsAsWideAsOfOthers) {
  const Charts charts = charts_of({{30, 40, 12, 11}, {20, 10, 200, 90}, {60, 30, 70, 160}});
  for (const int largest : {16, 32, 64, 256}) {
    Atlas atlas = lay_out(charts, {largest, 0}, {9, 9, 9});
    EXPECT_EQ(atlas.scaled_down, largest < 160 ? 2u : 0u);
    paint(
        atlas, charts, 1,
        [](std::size_t) {
          return ramps({256, 200});
        },
        0);
    for (std::size_t n = 0; n < charts.nodes.size(); ++n) {
      const std::uint32_t chart = charts.nodes[n].chart;
      const cv::Rect& rect = atlas.rects[chart];
      const Eigen::Vector2f& uv = atlas.uv[n];
      EXPECT_LE(std::max(rect.width, rect.height), largest);
      // A node may lie up to half a pixel nearer to the edge than the centre of its pixel.
      EXPECT_GE(uv.x() - static_cast<float>(rect.x), kBorder - 0.5f);
      EXPECT_GE(uv.y() - static_cast<float>(rect.y), kBorder - 0.5f);
      EXPECT_LE(uv.x(), static_cast<float>(rect.br().x - 1 - kBorder) + 0.5f);
      EXPECT_LE(uv.y(), static_cast<float>(rect.br().y - 1 - kBorder) + 0.5f);
    }
    const cv::Mat3b large = atlas.textures[atlas.texture_of[1]](atlas.rects[1]);
    // Along a row, x grows from the left border to the right border.
    for (int x = 1; x < large.cols; ++x)
      EXPECT_GE(large(large.rows / 2, x)[0], large(large.rows / 2, x - 1)[0]) << largest;
  }
}

}  // namespace
}  // namespace axial::texture
