// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a camera that are under adjustment, as people name them and know them.
#pragma once

#include <string>
#include <vector>

#include "base/option_list.h"
#include "pose/adjust.h"

namespace axial::pose {

// How well the free numbers were measured; 0: not at all.
struct Sigmas {
  double normal_degrees = 0;
  double distance = 0, centre = 0, thickness = 0;  // [m]
  double index = 0;
  double focal = 0;  // relative
};

// Declares the options --normal-sigma, --distance-sigma, --centre-sigma, --thickness-sigma and
// --index-sigma, bound to `sigmas`. Only the poses' program frees focal lengths (--focal-sigma).
void declare_sigmas(OptionList& list, Sigmas& sigmas);

// What --refine says, a list of normal, distance, centre, thickness, index and focal, and how well
// that was measured, into `adjust`: normal and distance of the flat ports, the centre of the domes,
// the others of all. Error for another word; for normal or distance without a flat port, the centre
// without a dome, or any number of a port where there are cameras in air; for a sigma that
// is negative, or of what is not refined; for a thickness without one, since it looks like
// distance; for the distance of a flat port where neither it nor any length is known, since only
// their ratio is seen.
void set_free_numbers(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                      AdjustOptions& adjust);

// What --refine calls the numbers that say where the port is.
std::string place_words(const refractive::Port<double>& port);

enum class Quantity { angle, place, index, thickness, focal };

// One number of a camera.
struct FreeValue {
  std::size_t number = 0;  // housing_change.h
  Quantity quantity = Quantity::place;
  std::string name, unit;
  double now = 0, sigma = 0;  // [unit]
  double scale = 1;           // of the unit, in that of housing_change.h: 1000 for mm
};

// Those under adjustment, with standard deviations `sigmas` as uncertainty() has them.
std::vector<FreeValue> free_values(const BundleCamera& camera, const HousingChange<double>& sigmas,
                                   const AdjustOptions& options);

}  // namespace axial::pose
