// SPDX-License-Identifier: GPL-3.0-or-later
// Resamples photographs and depth maps of any camera to a pinhole (PinholeView). A pixel of the
// pinhole sees a point X of the surface. The pixel gets the value of the camera's image at the
// projection of X into the camera. The result is exact where the depth map has a surface.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "cloud/pinhole_view.h"
#include "scene/depth_map.h"

namespace axial::cloud {

// Renders the surface of `map` into the pinhole. The result has the size of `view.camera` and one
// value for each pixel of the pinhole: 1 / z-depth [1/m] of the nearest surface, or 0 without a
// surface. Neighbouring pixels of `map` that have a depth form triangles. A triangle is left out if
// it bridges a step in depth, which means that its depths differ by more than 1 % and the angle
// between its plane and the ray is below 6 degrees. A triangle that the pinhole sees from behind is
// left out, too.
// `view`: the pinhole that replaces the map's camera (pinhole_for()), at any resolution. Throws an
// Error if the map and its camera differ in size.
cv::Mat1f render_surface(const DepthMap& map, const PinholeView& view);

// Returns `inverse_depth` with interpolated values in place of its zeros. The interpolation is
// smooth and uses the surrounding values. If all values are zero, the result is `otherwise`
// everywhere. Without zeros, the result shares its memory with `inverse_depth`.
cv::Mat1f filled(const cv::Mat1f& inverse_depth, float otherwise);

// Projects the points that the pinhole sees into `camera`, which the pinhole replaces, at any
// resolution. `inverse_depth`: 1 / z-depth [1/m] of the points in the rows [rows.start, rows.end)
// of the pinhole; its first row is rows.start. 0: no point. The result has the size of
// `inverse_depth`. It has the pixel (x, y) of `camera`, or (-10, -10) where there is no point or
// where `camera` does not see the point.
cv::Mat2f seen_by(const CameraModel& camera, const PinholeView& view,
                  const cv::Mat1f& inverse_depth, cv::Range rows);

// Values of PinholeImage::label: how the colour of a pixel was found. kNothing: the pixel is black,
// because the photograph has no pixel there, or because its pixel is transparent.
inline constexpr std::uint8_t kNothing = 0;
inline constexpr std::uint8_t kGuess = 128;  // the depth is interpolated between surfaces
inline constexpr std::uint8_t kExact = 255;  // the depth is that of a surface

// A photograph resampled to a pinhole. All images have the size of the pinhole's image.
struct PinholeImage {
  cv::Mat3b color;   // B G R
  cv::Mat1b label;   // kNothing, kGuess or kExact
  cv::Mat1b usable;  // 0 where the label is kNothing or the photograph is masked, otherwise 255
};

// Resamples a photograph (B G R) to the pinhole. The result has the size of `view.camera`.
// `opaque`: of the photograph's size and 0 where the photograph is transparent, or empty (opaque
// everywhere). `camera`: the photograph's camera at the photograph's resolution. `surface`: the
// result of render_surface(map, view) for the photograph's depth map. `guess`: inverse z-depths
// [1/m] of pixels without a surface: the result of filled() for the same view, at any resolution.
// `mask`: of the photograph's size and 0 where the photograph is masked, or empty (nowhere); it
// decides on PinholeImage::usable alone. Throws an Error if sizes disagree or if `guess` is empty.
PinholeImage resampled(const cv::Mat3b& photograph, const cv::Mat1b& opaque,
                       const CameraModel& camera, const PinholeView& view, const cv::Mat1f& surface,
                       const cv::Mat1f& guess, const cv::Mat1b& mask = {});

// Resamples a depth map to the pinhole. The result has the camera of `view` and its pose.
// `surface`: the result of render_surface(map, view), from which the depths are taken; the result
// has no depth where `surface` has none or where the camera of `map` does not see it. Normals and
// confidences are taken from the nearest pixel of `map`. A normal that faces away from the pinhole
// becomes 0. The range of depths is 0.9 times the smallest to 1.1 times the largest depth; without
// depths it is that of `map`. The ids and the image path are kept. Throws an Error if `surface` and
// the pinhole's camera differ in size.
DepthMap resampled(const DepthMap& map, const PinholeView& view, const cv::Mat1f& surface);

}  // namespace axial::cloud
