// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of the depth maps' errors, and helpers that combine numbers of several seeds. In all
// functions, `results` are the results of the whole experiment `reconstruction`, and `seeds` are
// the seeds of this experiment, at least one.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/reconstruction.h"

namespace axial::experiments {

using Seeds = std::vector<int>;

// Returns the median of value(seed) over the seeds.
double median_over(const Seeds& seeds, const std::function<double(int seed)>& value);
// Returns the texts text(seed) of all seeds, separated by commas.
std::string joined(const Seeds& seeds, const std::function<std::string(int seed)>& text);

// Errors of all pixels of all maps.
std::string maps_table(const Json& results, const Seeds& seeds);

// Errors by the class of a pixel (pixel_classes.h).
std::string places_table(const Json& results, const Seeds& seeds);

// Position errors in a source view [1/1000 px], by the fractional part of the true position
// (PhaseErrors).
std::string phases_table(const Json& results, const Seeds& seeds);

// Signed errors in rings around the image centre.
std::string rings_table(const Json& results, const Seeds& seeds);

// Compares our method under water with the images in air, ring by ring. Let m be the median of the
// relative error (estimate - truth) / truth in a ring. Let d be the median, over the seeds, of the
// difference between m of our method and m in air. Returns the largest |d| over the rings. Rings
// with few pixels do not count.
double largest_ring_difference(const Json& results, const Seeds& seeds);

}  // namespace axial::experiments
