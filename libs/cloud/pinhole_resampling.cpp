// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/pinhole_resampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/parallel.h"

namespace axial::cloud {
namespace {

constexpr float kNowhere = -10;

// Halves each side. A pixel becomes the mean of those of its four pixels that have a value.
cv::Mat1f halved(const cv::Mat1f& values) {
  cv::Mat1f half((values.rows + 1) / 2, (values.cols + 1) / 2, 0.0f);
  for (int y = 0; y < half.rows; ++y)
    for (int x = 0; x < half.cols; ++x) {
      float sum = 0, count = 0;
      for (int v = 2 * y; v < std::min(2 * y + 2, values.rows); ++v)
        for (int u = 2 * x; u < std::min(2 * x + 2, values.cols); ++u)
          if (values(v, u) != 0) sum += values(v, u), ++count;
      if (count > 0) half(y, x) = sum / count;
    }
  return half;
}

// Bilinear interpolation. Outside the image the value is that of the edge.
float value_at(const cv::Mat1f& values, double x, double y) {
  x = std::clamp(x, 0.0, values.cols - 1.0);
  y = std::clamp(y, 0.0, values.rows - 1.0);
  const int u = std::min(static_cast<int>(x), std::max(values.cols - 2, 0));
  const int v = std::min(static_cast<int>(y), std::max(values.rows - 2, 0));
  const int right = std::min(u + 1, values.cols - 1), below = std::min(v + 1, values.rows - 1);
  const auto a = static_cast<float>(x - u), b = static_cast<float>(y - v);
  return (1 - b) * ((1 - a) * values(v, u) + a * values(v, right)) +
         b * ((1 - a) * values(below, u) + a * values(below, right));
}

// The coordinate of a pixel's centre after resizing the image from `from` to `to` pixels.
double rescaled(int pixel, int from, int to) {
  return (pixel + 0.5) * to / from - 0.5;
}

// The rows of `surface`, with values of `guess` where there is no surface.
cv::Mat1f without_holes(const cv::Mat1f& surface, const cv::Mat1f& guess, cv::Range rows) {
  cv::Mat1f values = surface.rowRange(rows).clone();
  for (int i = 0; i < values.rows; ++i)
    for (int x = 0; x < values.cols; ++x)
      if (values(i, x) == 0)
        values(i, x) = value_at(guess, rescaled(x, surface.cols, guess.cols),
                                rescaled(rows.start + i, surface.rows, guess.rows));
  return values;
}

// The photograph's pixel nearest to `place`, or (-1, -1) outside the photograph.
cv::Point pixel_at(const cv::Vec2f& place, cv::Size photograph) {
  const cv::Point pixel(cvRound(place[0]), cvRound(place[1]));
  return cv::Rect({}, photograph).contains(pixel) ? pixel : cv::Point(-1, -1);
}

// Whether the pixel is in the photograph and not 0 in `marks`. Empty marks: nowhere 0.
bool is_marked(const cv::Mat1b& marks, cv::Point pixel) {
  return pixel.x >= 0 && (marks.empty() || marks(pixel) != 0);
}

void resample_rows(const cv::Mat3b& photograph, const cv::Mat1b& opaque, const cv::Mat1b& mask,
                   const cv::Mat2f& places, const cv::Mat1f& surface, PinholeImage rows) {
  cv::remap(photograph, rows.color, places, cv::noArray(), cv::INTER_LANCZOS4,
            cv::BORDER_REPLICATE);
  for (int y = 0; y < surface.rows; ++y)
    for (int x = 0; x < surface.cols; ++x) {
      const cv::Point pixel = pixel_at(places(y, x), photograph.size());
      const bool there = is_marked(opaque, pixel);
      rows.label(y, x) = !there ? kNothing : surface(y, x) != 0 ? kExact : kGuess;
      rows.usable(y, x) = there && is_marked(mask, pixel) ? 255 : 0;
      if (!there) rows.color(y, x) = {0, 0, 0};
    }
}

PinholeImage rows_of(const PinholeImage& image, cv::Range rows) {
  return {image.color.rowRange(rows), image.label.rowRange(rows), image.usable.rowRange(rows)};
}

}  // namespace

cv::Mat1f filled(const cv::Mat1f& inverse_depth, float otherwise) {
  const int values = cv::countNonZero(inverse_depth);
  if (values == static_cast<int>(inverse_depth.total())) return inverse_depth;
  if (values == 0) return cv::Mat1f(inverse_depth.size(), otherwise);
  const cv::Mat1f coarse = filled(halved(inverse_depth), otherwise);
  cv::Mat1f result = inverse_depth.clone();
  for (int y = 0; y < result.rows; ++y)
    for (int x = 0; x < result.cols; ++x)
      if (result(y, x) == 0)
        result(y, x) = value_at(coarse, rescaled(x, 2 * coarse.cols, coarse.cols),
                                rescaled(y, 2 * coarse.rows, coarse.rows));
  return result;
}

cv::Mat2f seen_by(const CameraModel& camera, const PinholeView& view,
                  const cv::Mat1f& inverse_depth, cv::Range rows) {
  cv::Mat2f places(rows.size(), view.camera.width, cv::Vec2f(kNowhere, kNowhere));
  std::visit(
      [&](const auto& exact) {
        for (int i = 0; i < places.rows; ++i)
          for (int x = 0; x < places.cols; ++x) {
            const float inverse = inverse_depth(i, x);
            if (inverse == 0) continue;
            const auto seen =
                exact.project(view.point({x, rows.start + i}, 1 / static_cast<double>(inverse)));
            if (seen.visible)
              places(i, x) = {static_cast<float>(seen.pixel.x()),
                              static_cast<float>(seen.pixel.y())};
          }
      },
      make_camera<double>(camera));
  return places;
}

PinholeImage resampled(const cv::Mat3b& photograph, const cv::Mat1b& opaque,
                       const CameraModel& camera, const PinholeView& view, const cv::Mat1f& surface,
                       const cv::Mat1f& guess, const cv::Mat1b& mask) {
  const cv::Size size(view.camera.width, view.camera.height);
  if (photograph.size() != cv::Size(camera.width, camera.height) || surface.size() != size ||
      (!opaque.empty() && opaque.size() != photograph.size()) ||
      (!mask.empty() && mask.size() != photograph.size()) || guess.empty())
    fail(
        "the photograph ({}x{}), its mask or its depth map has another size than the camera "
        "({}x{})",
        photograph.cols, photograph.rows, camera.width, camera.height);
  PinholeImage image{cv::Mat3b(size), cv::Mat1b(size), cv::Mat1b(size)};
  constexpr int kRows = 32;
  const auto strips = static_cast<std::size_t>((size.height + kRows - 1) / kRows);
  parallel_for(strips, [&](std::size_t strip) {
    const int first = static_cast<int>(strip) * kRows;
    const cv::Range rows(first, std::min(first + kRows, size.height));
    const cv::Mat2f places = seen_by(camera, view, without_holes(surface, guess, rows), rows);
    resample_rows(photograph, opaque, mask, places, surface.rowRange(rows), rows_of(image, rows));
  });
  return image;
}

DepthMap resampled(const DepthMap& map, const PinholeView& view, const cv::Mat1f& surface) {
  if (surface.size() != cv::Size(view.camera.width, view.camera.height))
    fail_in(map.image_path, "the surface is {}x{}, but its camera is {}x{}", surface.cols,
            surface.rows, view.camera.width, view.camera.height);
  DepthMap result;
  result.image_path = map.image_path;
  result.ids = map.ids;
  result.camera = view.camera;
  result.pose = view.pose(map.pose);
  result.depth = cv::Mat1f(surface.size(), 0.0f);
  if (!map.normal.empty()) result.normal = cv::Mat3f(surface.size(), cv::Vec3f(0, 0, 0));
  if (!map.confidence.empty()) result.confidence = cv::Mat1f(surface.size(), 0.0f);
  float nearest = std::numeric_limits<float>::max(), farthest = 0;
  const cv::Mat2f places = seen_by(map.camera, view, surface, {0, surface.rows});
  for (int y = 0; y < surface.rows; ++y)
    for (int x = 0; x < surface.cols; ++x) {
      const cv::Point from = pixel_at(places(y, x), map.depth.size());
      if (surface(y, x) == 0 || from.x < 0) continue;
      const Eigen::Vector3d bearing = view.camera.lens.bearing({x, y});
      const auto depth = static_cast<float>(bearing.norm() / static_cast<double>(surface(y, x)));
      result.depth(y, x) = depth;
      nearest = std::min(nearest, depth), farthest = std::max(farthest, depth);
      if (!map.confidence.empty()) result.confidence(y, x) = map.confidence(from);
      if (map.normal.empty()) continue;
      const cv::Vec3f& n = map.normal(from);
      const Eigen::Vector3f normal(n[0], n[1], n[2]);
      if (normal.cast<double>().dot(bearing) < 0) result.normal(y, x) = n;
    }
  result.min_depth = farthest > 0 ? 0.9f * nearest : map.min_depth;
  result.max_depth = farthest > 0 ? 1.1f * farthest : map.max_depth;
  return result;
}

}  // namespace axial::cloud
