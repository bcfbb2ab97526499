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
  int reach = 4;               // windows are 2 * reach + 1 pixels wide and high; at least 1
  double jump = 1.02;          // neighbours with at least this ratio of true distances are an edge
  double least_deviation = 5;  // windows with a smaller standard deviation of grey have no texture
  double steep_degrees = 60;   // steep: a larger angle between the ray and the surface normal
};

// Classifies the pixels. `truth`: distances along the rays of `camera` [m], 0 where there is no
// truth. `grey`: the photograph. Error if `truth` or `grey` does not have the size of the camera's
// image, or if the reach is less than 1.
PixelClassMap classes_of(const cv::Mat1f& truth, const CameraModel& camera, const cv::Mat1b& grey,
                         const PixelClassOptions& options = {});

// A depth map, its evaluation, and the classes of its pixels.
struct ClassifiedMap {
  const DepthMap* map;
  DepthEvaluation evaluation;
  PixelClassMap classes;
};

// True if |error| is more than 2 % of the true distance: the default of PixelClassOptions::jump,
// minus 1. `error` and `truth`: [m]. Gross errors are counted apart, because a mean that includes
// them says nothing about the other errors. Most points with gross errors lie on another surface or
// on no surface.
bool is_gross(float error, float truth);

// The values |estimate - truth| [m] of the pixels that have an estimate and a truth.
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
  double mean = 0;               // of the errors that are not gross [m]; 0 without such errors
};

// Returns the errors of each class, from `edge` to `open`. A class contains its pixels of all maps.
std::array<ClassErrors, 4> errors_by_class(std::span<const ClassifiedMap> maps);

// Pixels whose true position in a source view has a fractional part within [begin, end).
struct PhaseErrors {
  double begin = 0, end = 0;
  std::size_t count = 0;
  double shift = 0;  // median of estimated minus true position [px]
};

// Returns the position errors of open pixels in a source view, in `bins` bins of equal width over
// the fractional part of the true position. The source view of a map is the first of the map's
// neighbours (DepthMap::ids) that is among `maps`. Maps without such a neighbour are left out. The
// true position is the image of the pixel's true point in the source view. The position is measured
// along one image axis: the axis along which a change of depth moves the image more. The shift
// is the depth error times the derivative of the position by the depth. Pixels are left out if
// their true point is not visible in the source view. Pixels with a shift of more than half a pixel
// are left out, because such shifts have other causes. A bias by interpolation, or by rounding in
// the projection, appears as a wave over the fractional part.
std::vector<PhaseErrors> errors_by_phase(std::span<const ClassifiedMap> maps, std::size_t bins);

}  // namespace axial::evaluate
