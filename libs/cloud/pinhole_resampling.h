// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs and depth maps of any camera as a pinhole would have them (PinholeView): each of its
// pixels takes what the camera has at the image of the surface point that the pixel sees. Exact
// where the depth map has a surface.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "cloud/pinhole_view.h"
#include "scene/depth_map.h"

namespace axial::cloud {

// 1 / z-depth from the pinhole of the first surface that each of its pixels sees [1/m]; 0: none.
// Neighbouring pixels of `map` are joined to triangles, unless there is a step between them: depths
// that differ by more than 1 % on a surface that is seen at less than 6 degrees. `view` stands for
// the map's camera, at any resolution.
cv::Mat1f render_surface(const DepthMap& map, const PinholeView& view);

// `inverse_depth` with its zeros filled smoothly by what surrounds them; `otherwise` if all of it
// is zero.
cv::Mat1f filled(const cv::Mat1f& inverse_depth, float otherwise);

// Where `camera` images the points that rows [rows.start, rows.end) of the pinhole see, with
// `inverse_depth` of these rows alone (0: no point). (-10, -10) where it does not.
cv::Mat2f seen_by(const CameraModel& camera, const PinholeView& view,
                  const cv::Mat1f& inverse_depth, cv::Range rows);

// Values of PinholeImage::label.
inline constexpr std::uint8_t kNothing =
    0;  // black: no pixel of the photograph, or a transparent one
inline constexpr std::uint8_t kGuess = 128;  // the depth is interpolated between surfaces
inline constexpr std::uint8_t kExact = 255;

struct PinholeImage {
  cv::Mat3b color;
  cv::Mat1b label;
};

// The pinhole's image of `view.camera`'s size. `opaque`: empty, or 0 where the photograph is
// transparent. `camera`: at the photograph's resolution. `surface`: render_surface(map, view).
// `guess`: depths of any resolution for pixels without a surface, by filled(). Error if sizes
// disagree.
PinholeImage resampled(const cv::Mat3b& photograph, const cv::Mat1b& opaque,
                       const CameraModel& camera, const PinholeView& view, const cv::Mat1f& surface,
                       const cv::Mat1f& guess);

// The map as the pinhole's, of `view.camera`'s size: depths of `surface`, which is
// render_surface(map, view); normals and confidences of the map's nearest pixel, normals that the
// pinhole would see from behind as 0. Its ids and image path stay.
DepthMap resampled(const DepthMap& map, const PinholeView& view, const cv::Mat1f& surface);

}  // namespace axial::cloud
