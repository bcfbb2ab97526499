// SPDX-License-Identifier: GPL-3.0-or-later
// Where in depth maps the errors are, and whether depths are drawn towards whole pixels of a source
// view.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "evaluate/depth_evaluation.h"
#include "scene/depth_map.h"

namespace axial::evaluate {

// What a pixel lies on, the first that applies.
enum class Place : std::uint8_t {
  nothing,  // no truth
  edge,     // a window around the pixel sees two surfaces, or pixels without truth
  plain,    // no texture
  steep,    // the surface turns away
  open      // none of these
};

struct PlaceMap {
  int width = 0, height = 0;
  std::vector<Place> pixels;  // row-major

  Place at(int u, int v) const {
    return pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(u)];
  }
};

struct PlaceOptions {
  int reach = 4;               // half of the matching window [px], at least 1
  double jump = 1.02;          // ratio of neighbouring true distances that is an edge
  double least_deviation = 5;  // standard one of the grey values in the window, else it is plain
  double steep_degrees = 60;   // between the ray and the surface's normal
};

// `truth`: distances along the rays of `camera` [m], 0: none. `grey`: the photograph. Both of the
// camera's size. Error if they are not.
PlaceMap places_of(const cv::Mat1f& truth, const CameraModel& camera, const cv::Mat1b& grey,
                   const PlaceOptions& options = {});

// A depth map, what it is worth, and what its pixels lie on.
struct PlacedMap {
  const DepthMap* map;
  DepthEvaluation evaluation;
  PlaceMap places;
};

// An error of more than PlaceOptions::jump - 1 of the true distance: mostly another surface, or
// none. A mean that has such errors in it says nothing of the others.
bool is_gross(float error, float truth);

// |estimate - truth| [m] of pixels that have both.
struct Magnitudes {
  std::vector<float> all, fine;  // fine: those not gross

  // Nothing where `error` is not finite: no estimate, or no truth.
  void add(float error, float truth);
  std::size_t gross() const { return all.size() - fine.size(); }
};

struct PlaceErrors {
  Place place;
  std::size_t truth_pixels = 0, compared_pixels = 0;
  std::size_t gross_pixels = 0;  // of the compared ones
  double median = 0;             // of |estimate - truth| [m]; 0 where nothing is compared
  double mean = 0;               // the same, of those not gross; 0 where there are none
};

// All pixels of all maps, from `edge` to `open`.
std::array<PlaceErrors, 4> errors_by_place(std::span<const PlacedMap> maps);

// Pixels whose true image in a source view lies between two fractions of a pixel.
struct PhaseErrors {
  double begin = 0, end = 0;
  std::size_t count = 0;
  double shift = 0;  // median of estimated minus true position there [px]
};

// Of all open pixels that the source view images, along its axis (columns or rows) on which a depth
// moves the image more; `bins` of equal width. The source view is the first one of a map's list
// that is among `maps`. Pixels more than half a pixel off are left out: they are wrong for other
// reasons. What interpolation or a rounded projection does to depths comes out as a wave over the
// pixel.
std::vector<PhaseErrors> errors_by_phase(std::span<const PlacedMap> maps, std::size_t bins);

}  // namespace axial::evaluate
