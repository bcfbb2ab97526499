// SPDX-License-Identifier: GPL-3.0-or-later
// Finds where in depth maps the errors are, and whether depths are biased towards whole pixels of a
// source view.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "evaluate/depth_evaluation.h"
#include "scene/depth_map.h"

namespace axial::evaluate {

// The class of a pixel; the first that applies.
enum class PixelClass : std::uint8_t {
  nothing,  // no truth
  edge,     // the window around the pixel contains two surfaces, or pixels without truth
  plain,    // no texture
  steep,    // the surface is seen at a steep angle
  open      // none of the other classes
};

struct PixelClassMap {
  int width = 0, height = 0;
  std::vector<PixelClass> pixels;  // row-major

  PixelClass at(int u, int v) const {
    return pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(u)];
  }
};

struct PixelClassOptions {
  int reach = 4;               // half of the matching window [px], at least 1
  double jump = 1.02;          // ratio of neighbouring true distances at an edge
  double least_deviation = 5;  // standard deviation of grey values in a window with texture
  double steep_degrees = 60;   // angle between the ray and the surface normal
};

// Classifies the pixels. `truth`: distances along the rays of `camera` [m]; 0: no truth. `grey`:
// the photograph. Error unless both have the size of the camera's image and the reach is at least
// 1.
PixelClassMap classes_of(const cv::Mat1f& truth, const CameraModel& camera, const cv::Mat1b& grey,
                         const PixelClassOptions& options = {});

// A depth map, its evaluation, and the classes of its pixels.
struct ClassifiedMap {
  const DepthMap* map;
  DepthEvaluation evaluation;
  PixelClassMap classes;
};

// True for an error of more than 2 % of the true distance (PixelClassOptions::jump - 1). Most gross
// errors lie on another surface or on none. A mean that includes gross errors says nothing about
// the other errors.
bool is_gross(float error, float truth);

// Values of |estimate - truth| [m] of pixels that have both.
struct Magnitudes {
  std::vector<float> all, fine;  // fine: without gross errors

  // Ignores the pixel if `error` is not finite (no estimate or no truth).
  void add(float error, float truth);
  std::size_t gross() const { return all.size() - fine.size(); }
};

struct ClassErrors {
  PixelClass pixel_class;
  std::size_t truth_pixels = 0, compared_pixels = 0;
  std::size_t gross_pixels = 0;  // compared pixels with a gross error
  double median = 0;             // of |estimate - truth| [m]; 0 without compared pixels
  double mean = 0;               // of the errors that are not gross [m]; 0 without any
};

// Returns the errors of all pixels of all maps for each class from `edge` to `open`.
std::array<ClassErrors, 4> errors_by_class(std::span<const ClassifiedMap> maps);

// Pixels whose true position in a source view has a fractional part within [begin, end).
struct PhaseErrors {
  double begin = 0, end = 0;
  std::size_t count = 0;
  double shift = 0;  // median of estimated minus true position [px]
};

// Returns `bins` bins of equal width over all open pixels that are visible in a source view. The
// source view of a map is the first one in its list that is among `maps`. Positions are taken along
// the axis of the source view (columns or rows) in which a change of depth moves the image more.
// Pixels that are off by more than half a pixel are left out, because they are wrong for other
// reasons. Interpolation, or rounding in the projection, shows as a wave over the fraction of a
// pixel.
std::vector<PhaseErrors> errors_by_phase(std::span<const ClassifiedMap> maps, std::size_t bins);

}  // namespace axial::evaluate
