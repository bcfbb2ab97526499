// SPDX-License-Identifier: GPL-3.0-or-later
// Filters for finished depth maps: removal of small segments, filling of small gaps, and adjustment
// to the depth maps of neighbouring views. All functions return a new map and leave their arguments
// unchanged. The result shares no depths, normals or confidences with the arguments. Maps may have
// no normals or no confidences. A pixel is valid if its depth is above 0. Cleared means that depth,
// normal and confidence are set to 0.
#pragma once

#include <cstdint>
#include <span>

#include "axial/depth.h"
#include "scene/depth_map.h"

namespace axial::depth {

// Clears the pixels of small segments. A segment is a connected set of valid pixels. Two pixels
// that share an edge are connected if their depths differ by less than max_difference, relative to
// the smaller depth.
DepthMap remove_speckles(const DepthMap& map, const SpeckleOptions& options = {});

// Fills gaps, first along rows, then along columns. A gap is a run of at most max_gap pixels that
// are not valid, between two valid pixels (the ends). The depths of the ends differ by less than
// max_difference, relative to the smaller depth. Inverse depth is interpolated linearly, so that a
// plane is continued as a plane. Normals are interpolated linearly and normalised. The confidence
// is the smaller confidence of the two ends. `mask`: pixels with a value other than 0 are not
// filled, but count for the length of a gap. Precondition: `mask` is empty (all pixels may be
// filled) or has the size of the map.
DepthMap fill_gaps(const DepthMap& map, const GapOptions& options = {},
                   const cv::Mat1b& mask = cv::Mat1b());

struct AdjustOptions {
  float max_difference = 0.012f;   // relative difference of depth below which two maps agree
  int min_agreeing = 1;            // number of neighbours that must agree with a pixel
  int min_seeing = 2;              // number of neighbours that must have a depth at a pixel
  std::size_t max_neighbours = 8;  // if the list is longer, only its first entries are used
};

// Adjusts the depths of `reference` to the depth maps of neighbouring views.
//
// * Each neighbour's points are projected exactly into the reference. A point gives a depth to
//   each of the 4 pixels around its projection: the distance lambda (eq. 4) at which the pixel's
//   ray meets the point's tangent plane. If the point has no normal, or the ray grazes the plane or
//   meets it from behind, lambda is the point's position along the ray instead.
// * A z-buffer keeps one depth per pixel and neighbour: the smallest. Of depths that differ by at
//   most max_difference, it keeps the depth of the point whose projection is nearest to the pixel.
// * A neighbour that has a depth at a pixel agrees with the pixel if the two depths differ by
//   less than max_difference, relative to the reference's depth. Otherwise the neighbour
//   contradicts.
// * The weight of a neighbour is the confidence of its point, or 1 if its map has no confidences.
//   There is one exception: if a neighbour contradicts with a larger depth, it sees through the
//   pixel's surface point. If the surface point projects to a pixel of the neighbour that has a
//   depth, the weight of the neighbour is the confidence of this pixel of the neighbour.
// * The new depth is the weighted mean of the reference's depth, weighted by its confidence, and
//   of the neighbours' depths that agree. The new confidence is the reference's confidence, plus
//   the weights of the neighbours that agree, minus the weights of the neighbours that
//   contradict.
// * A pixel is cleared if its new confidence is not positive, if too few neighbours agree
//   (min_agreeing), if too few neighbours have a depth at the pixel (min_seeing, but at most the
//   number of neighbours), or if the new depth is outside [min_depth, max_depth] of `reference`
//   (tested only if max_depth > 0). So all pixels are cleared if there are no neighbours, unless
//   min_agreeing is 0.
//
// Pixels of `reference` that are not valid stay so, and normals do not change. The result always
// has confidences. If `reference` has none, its confidences count as 1.
//
// To filter all maps of a scene, pass the unfiltered maps and replace them after the last call.
// Throws an Error for a map that is empty, for a map whose camera, normals or confidences differ
// in size from its depths, and for a `reference` whose depths are a part of a larger cv::Mat.
DepthMap adjust_with_neighbours(const DepthMap& reference, std::span<const DepthMap> neighbours,
                                const AdjustOptions& options = {});

// The sizes on which the memory of adjust_with_neighbours() depends.
struct AdjustSize {
  std::uint64_t pixels = 0;      // number of pixels of the reference
  std::uint64_t neighbours = 0;  // number of neighbours that are used
};

// An upper bound of the memory [bytes] of adjust_with_neighbours(). Includes the result, but not
// the arguments.
std::uint64_t bytes_needed(const AdjustSize& size);

}  // namespace axial::depth
