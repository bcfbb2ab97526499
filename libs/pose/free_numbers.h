// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a camera that are under adjustment: their names in options and reports.
#pragma once

#include <string>
#include <vector>

#include "base/option_list.h"
#include "base/setting_names.h"
#include "pose/adjust.h"

namespace axial::pose {

// The standard deviations with which the free numbers were measured. 0: not measured.
struct Sigmas {
  double normal_degrees = 0;
  double distance = 0, centre = 0, thickness = 0;  // [m]
  double index = 0;
  double focal = 0;  // relative
};

// Adds the options --normal-sigma, --distance-sigma, --centre-sigma, --thickness-sigma and
// --index-sigma, bound to `sigmas`. RefinePoses alone adjusts focal lengths and adds --focal-sigma
// itself.
void declare_sigmas(OptionList& list, Sigmas& sigmas);

// Sets the unknowns of `adjust` from `refine`, a comma-separated list of normal, distance, centre,
// thickness, index and focal. Normal and distance apply to flat ports, centre to
// domes, the other words to all cameras.
//
// Error for an unknown word; for normal or distance without a flat port; for centre without a dome;
// for any number of a port where some cameras are in air; for a negative standard deviation, or one
// of a number that `refine` does not name; for a thickness without a standard deviation, since its
// effect looks like that of the distance; for a distance of a flat port where neither its standard
// deviation nor any length is known, since photographs show only the ratio of lengths.
//
// Messages name the settings "refine", "normal_sigma", "distance_sigma", "centre_sigma",
// "thickness_sigma", "index_sigma" and "focal_sigma". A message about an unknown length also names
// the settings that make lengths known: "distances" and "poses_known" of AdjustOptions.
void set_free_numbers(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                      AdjustOptions& adjust, SettingNames name_of = own_name);

// The words of `refine` for the place of the port: "normal,distance" or "centre".
std::string place_words(const refractive::Port<double>& port);

enum class Quantity { angle, place, index, thickness, focal };

// One number of a camera.
struct FreeValue {
  std::size_t number = 0;  // housing_change.h
  Quantity quantity = Quantity::place;
  std::string name, unit;
  double now = 0, sigma = 0;  // [unit]
  double scale = 1;           // factor from the unit of housing_change.h to `unit`: 1000 for mm
};

// The numbers of `camera` under adjustment, with their standard deviations. `sigmas` as
// Uncertainty::camera_sigmas.
std::vector<FreeValue> free_values(const BundleCamera& camera, const HousingChange<double>& sigmas,
                                   const AdjustOptions& options);

}  // namespace axial::pose
