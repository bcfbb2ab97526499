// SPDX-License-Identifier: GPL-3.0-or-later
// The free numbers of a camera, which adjust() changes: their names in options and reports.
// housing_change.h lists all numbers.
#pragma once

#include <string>
#include <vector>

#include "base/option_list.h"
#include "base/setting_names.h"
#include "pose/adjust.h"

namespace axial::pose {

// The standard deviations with which numbers were measured. 0: not stated. Distance and normal are
// those of a flat port, the centre is that of a dome, for each of its coordinates.
struct Sigmas {
  double normal_degrees = 0;                       // for each of its two tilts
  double distance = 0, centre = 0, thickness = 0;  // [m]
  double index = 0;                                // of the refractive index of the water
  double focal = 0;  // standard deviation of the focal length, divided by the focal length
};

// Adds the options --normal-sigma, --distance-sigma, --centre-sigma, --thickness-sigma and
// --index-sigma, bound to `sigmas`, which must exist until parse_options() has returned. The
// defaults are the present values. RefinePoses alone adjusts focal lengths and adds --focal-sigma
// itself.
void declare_sigmas(OptionList& list, Sigmas& sigmas);

// The standard deviations of numbers that were measured with a ruler, and of a lens and of water
// that were not calibrated for the dive: 3 degrees, 5 mm, 0.5 mm for the thickness, 0.004, 0.5 %.
Sigmas ruler_sigmas();

// Sets the unknowns of `adjust` (Unknowns, of_domes and of_air), whose other members are only read,
// from
// `refine`, a comma-separated list of the words normal, distance, centre (or center), thickness,
// index and focal. An empty list frees no number. `normal` and `distance` apply to flat ports,
// `centre` applies to domes, and the other words apply to all cameras. The standard deviations of
// `sigmas` become Unknowns::prior_sigma. Where `sigmas` states none, BundleCamera::stated_sigma
// applies.
//
// Throws an Error in these cases:
// - The list has an unknown word.
// - `normal` or `distance` is listed and there is no flat port, or `centre` is listed and there is
//   no dome.
// - Any word other than `focal` is listed and some cameras are in air.
// - A standard deviation is negative or not finite, or it is positive and its number is not listed.
// - `thickness` is listed without a standard deviation of any camera, because the effects of
//   thickness and distance look alike.
// - `distance` is listed without a standard deviation of any camera, and `adjust` has no known
//   distances, positions, points or poses, because photographs show only ratios of lengths.
//
// Messages name the settings "refine", "normal_sigma", "distance_sigma", "centre_sigma",
// "thickness_sigma", "index_sigma" and "focal_sigma". A message about an unknown length also names
// "distances" and "poses_known", the settings of AdjustOptions that make lengths known. `name_of`
// turns a name into the name that the user knows.
void set_free_numbers(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                      AdjustOptions& adjust, SettingNames name_of = own_name);

// The same for measured numbers of which some may be estimated. `refine` is "auto", "none" or a
// list as above:
// - "auto" frees all numbers of the cameras, with two exceptions. A thickness is free only if
//   `sigmas` or a camera states its standard deviation. With known poses no number is free. Where
//   nobody states a standard deviation, ruler_sigmas() applies.
// - "none" frees no number, and a list frees the listed numbers. Numbers that stay fixed have the
//   standard deviations that the cameras state, or those of ruler_sigmas(). Exception: a thickness
//   counts as exact unless a camera states its standard deviation.
void set_estimated_numbers(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                           AdjustOptions& adjust, SettingNames name_of = own_name);

// The words of `refine` (set_free_numbers) that free the place of the port: "normal,distance" for a
// flat port, "centre" for a dome.
std::string place_words(const refractive::Port<double>& port);

// The kind of a number. place: a length of the port's position, that is, a distance or a coordinate
// of a centre.
enum class Quantity { angle, place, index, thickness, focal };

// One number of a camera, for reports.
struct FreeValue {
  std::size_t number = 0;  // index of the number in housing_change.h
  Quantity quantity = Quantity::place;
  std::string name, unit;     // for example "distance" and "mm"; a number without unit: ""
  double now = 0, sigma = 0;  // present value and its standard deviation [unit]
  double scale = 1;           // factor from the unit of housing_change.h to `unit`: 1000 for mm
  // The measured value and its standard deviation [unit]; 0: not measured.
  double before = 0, sigma_before = 0;

  // True if the photographs say more about the value than its measurement: `sigma` is less than
  // half of `sigma_before`, or the value was not measured. False if the measured value was kept.
  bool by_photographs() const {
    return !(sigma_before > 0) || (now != before && sigma < sigma_before / 2);
  }
};

// The free numbers of `camera` with their present values and their standard deviations, by
// ascending FreeValue::number. The value of the focal length is the factor from the measured to the
// present focal length. `options` tells which numbers are free. `sigmas`: the entry of
// Uncertainty::camera_sigmas for this camera.
std::vector<FreeValue> free_values(const BundleCamera& camera, const HousingChange<double>& sigmas,
                                   const AdjustOptions& options);

}  // namespace axial::pose
