// SPDX-License-Identifier: GPL-3.0-or-later
// Divides the errors of depth maps among classes of pixels, and shows whether depths are biased
// towards whole pixels of a source view.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "evaluate/depth_evaluation.h"
#include "scene/depth_map.h"

namespace axial::evaluate {

// The class of a pixel. If several classes apply, the first of this list is taken.
// PixelClassOptions defines the window and the limits.
enum class PixelClass : std::uint8_t {
  nothing,  // no truth
  edge,     // the window around the pixel contains two surfaces, or pixels without truth
  plain,    // the photograph has no texture in the window around the pixel
  steep,    // the surface is seen at a steep angle
  open      // none of the other classes
};

// The classes of the pixels of an image.
struct PixelClassMap {
  int width = 0, height = 0;       // [px]
  std::vector<PixelClass> pixels;  // row-major

  // The class of the pixel in column u of row v. Precondition: 0 <= u < width, 0 <= v < height.
  PixelClass at(int u, int v) const {
    return pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(u)];
  }
};

struct PixelClassOptions {
  int reach = 4;  // windows are 2 * reach + 1 pixels wide and high; at least 1
  // Two pixels side by side show two surfaces if the ratio of the larger to the smaller true
  // distance is at least `jump`.
  double jump = 1.02;
  // A window has no texture if the standard deviation of its grey levels (0 to 255) is less than
  // `least_deviation`.
  double least_deviation = 5;
  // The surface is seen at a steep angle if the angle between the ray and the surface normal is
  // larger than `steep_degrees`.
  double steep_degrees = 60;
};

// Returns the class of each pixel of `camera`. `truth`: distances along the rays of `camera` [m], 0
// where there is no truth. `grey`: the photograph. Error if `truth` or `grey` does not have the
// size of the camera's image, or if `options.reach` is less than 1.
PixelClassMap classes_of(const cv::Mat1f& truth, const CameraModel& camera, const cv::Mat1b& grey,
                         const PixelClassOptions& options = {});

// A depth map, its evaluation by evaluate_depth(), and the classes of its pixels. All three have
// the same size.
struct ClassifiedMap {
  const DepthMap* map;  // not null; the caller keeps the map alive
  DepthEvaluation evaluation;
  PixelClassMap classes;
};

// True if `error` is gross: |error| is more than 2 % of the true distance `truth`. 2 % is the
// default of PixelClassOptions::jump, minus 1. `error`: estimate - truth. `error` and `truth`: [m].
// Gross errors are counted apart, because a mean that includes them says nothing about the other
// errors. Most points with gross errors lie on another surface or on no surface.
bool is_gross(float error, float truth);

// The values |estimate - truth| [m] of the pixels that have an estimate and a truth.
struct Magnitudes {
  std::vector<float> all, fine;  // fine: without gross errors

  // Adds a pixel. `error`: estimate - truth [m]. `truth`: the true distance [m]. Ignores the pixel
  // if `error` is not finite (no estimate or no truth).
  void add(float error, float truth);
  // The number of gross errors.
  std::size_t gross() const { return all.size() - fine.size(); }
};

// Errors of the pixels of one class.
struct ClassErrors {
  PixelClass pixel_class;
  // All pixels of the class, which all have a truth, and those of them that have an estimate.
  std::size_t truth_pixels = 0, compared_pixels = 0;
  std::size_t gross_pixels = 0;  // compared pixels with a gross error
  double median = 0;  // of |estimate - truth| of the compared pixels [m]; 0 without such pixels
  // Mean of |estimate - truth| of the compared pixels without a gross error [m]; 0 without such
  // pixels.
  double mean = 0;
};

// Returns the errors of the classes edge, plain, steep and open, in this order. A class contains
// its pixels of all maps.
std::array<ClassErrors, 4> errors_by_class(std::span<const ClassifiedMap> maps);

// Errors of the pixels whose true position in a source view has a fractional part within
// [begin, end) [px].
struct PhaseErrors {
  double begin = 0, end = 0;
  std::size_t count = 0;  // number of pixels
  double shift = 0;       // median of estimated minus true position [px]; 0 without pixels
};

// Returns the position errors of open pixels in a source view, in `bins` bins of equal width over
// the fractional part of the true position, in ascending order. The source view of a map is the
// first of the map's source views (DepthMap::ids) whose own map is among `maps`. Maps without such
// a source view are left out. The true position is the image of the pixel's true point in the
// source view. The position is measured along one image axis: the axis along which a change of
// depth moves the image more. The estimated position is the true position plus the shift, which is
// the depth error times the derivative of the position by the depth. Pixels are left out if their
// true point is not projected into the image of the source view. Occlusion is not tested. Pixels
// with a shift of more than half a pixel are left out, because such shifts have other causes. A
// bias by interpolation, or by rounding in the projection, appears as a wave over the fractional
// part. Precondition: `bins` is at least 1.
std::vector<PhaseErrors> errors_by_phase(std::span<const ClassifiedMap> maps, std::size_t bins);

}  // namespace axial::evaluate
