// SPDX-License-Identifier: GPL-3.0-or-later
// The free numbers of a camera, which adjust() changes: their names in options and reports.
// housing_change.h lists all numbers.
#pragma once

#include <string>
#include <vector>

#include "axial/base.h"
#include "base/program/option_list.h"
#include "pose/bundle/adjust_options.h"
#include "pose/bundle/housing_numbers.h"

namespace axial::pose {

// Adds the options --normal-sigma, --distance-sigma, --centre-sigma, --thickness-sigma and
// --index-sigma, bound to `sigmas`, which must exist until parse_options() has returned. The
// defaults are the present values. RefinePoses alone adjusts focal lengths and adds --focal-sigma
// itself.
void declare_sigmas(OptionList& list, Sigmas& sigmas);

// The unknowns of a camera with a port of this kind: the numbers whose standard deviations
// `measured` states are free and have these standard deviations. All others are fixed.
Unknowns unknowns_with(PortKind kind, const Sigmas& measured);

// Sets the unknowns of `adjust` (Unknowns, of_domes and of_air), whose other members are only read,
// from `refine`, a comma-separated list of the words normal, distance, centre (or center),
// thickness, index and focal. An empty list frees no number. `normal` and `distance` apply to flat
// ports, `centre` applies to domes, and the other words apply to all cameras. The standard
// deviations of `sigmas` become Unknowns::prior_sigma. Where `sigmas` states none,
// BundleCamera::stated_sigma applies.
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
// "distances" and "poses_known", the settings of AdjustOptions that make lengths known.
void set_free_numbers(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                      AdjustOptions& adjust);

// The same for measured numbers of which some may be estimated. `refine` is "auto", "none" or a
// list as above:
// - "auto" frees all numbers of the cameras, with two exceptions. A thickness is free only if
//   `sigmas` or a camera states its standard deviation. With known poses no number is free. Where
//   nobody states a standard deviation, ruler_sigmas() applies.
// - "none" frees no number, and a list frees the listed numbers. Numbers that stay fixed have the
//   standard deviations that the cameras state, or those of ruler_sigmas(). Exception: a thickness
//   counts as exact unless a camera states its standard deviation.
void set_estimated_numbers(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                           AdjustOptions& adjust);

// The words of `refine` (set_free_numbers) that free the place of the port: "normal,distance" for a
// flat port, "centre" for a dome.
std::string place_words(const refractive::Port<double>& port);

// The free numbers of the cameras, by camera and ascending HousingNumber::number. The value of a
// focal length is the factor from the measured to the present focal length. `sigmas`: the standard
// deviations of the numbers of each camera (Uncertainty::camera_sigmas). Empty: all are 0.
std::vector<HousingNumber> free_values(const Bundle& bundle,
                                       std::span<const HousingChange<double>> sigmas,
                                       const AdjustOptions& options);

}  // namespace axial::pose
