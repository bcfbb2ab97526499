// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of the depth maps' errors, and helpers that combine numbers of several seeds. `results`
// are of the whole experiment `reconstruction`; `seeds` are its seeds, at least one.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/reconstruction.h"

namespace axial::experiments {

using Seeds = std::vector<int>;

// The median of the values of the seeds.
double median_over(const Seeds& seeds, const std::function<double(int seed)>& value);
// The texts of the seeds, separated by commas.
std::string joined(const Seeds& seeds, const std::function<std::string(int seed)>& text);

// Errors of all pixels of all maps.
std::string maps_table(const Json& results, const Seeds& seeds);

// Errors by the class of a pixel (pixel_classes.h).
std::string places_table(const Json& results, const Seeds& seeds);

// Shifts of points' images in a source view (PhaseErrors), by the fractional part of their true
// position [px].
std::string phases_table(const Json& results, const Seeds& seeds);

// Signed errors in rings around the image centre.
std::string rings_table(const Json& results, const Seeds& seeds);

// The largest absolute difference over all rings between the median error of our method and of the
// images in air, as a fraction of the depth; each is the median over the seeds. Rings with few
// pixels do not count.
double largest_ring_difference(const Json& results, const Seeds& seeds);

}  // namespace axial::experiments
