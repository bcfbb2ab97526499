// SPDX-License-Identifier: GPL-3.0-or-later
// What the reader sees of the depth maps, and how numbers of several seeds are shown.
#pragma once

#include <functional>

#include "reconstruction.h"

namespace axial {

using Seeds = std::vector<int>;

double median_over(const Seeds& seeds, const std::function<double(int seed)>& value);
std::string joined(const Seeds& seeds, const std::function<std::string(int seed)>& text);

// Errors of all pixels of all maps.
std::string maps_table(const Json& results, const Seeds& seeds);

// Errors by what a pixel lies on.
std::string places_table(const Json& results, const Seeds& seeds);

// Shifts in the source view by where in its pixel the true image lies.
std::string phases_table(const Json& results, const Seeds& seeds);

// Signed errors in rings around the image centre.
std::string rings_table(const Json& results, const Seeds& seeds);

// By how much our method's median in a ring differs from that in air, in the ring where it does
// most; as a fraction of the depth.
double largest_ring_difference(const Json& results, const Seeds& seeds);

}  // namespace axial
