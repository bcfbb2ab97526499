// SPDX-License-Identifier: GPL-3.0-or-later
// The loss of daylight by depth, from the loss along the rays of the cameras.
//
// Jerlov's types of water (Marine Optics, 1976, table XXVII) give the loss of daylight by depth,
// K_d. Kirk's relation (1984), K_d = sqrt(a^2 + (0.425 m - 0.19) a s) / m with the mean cosine of
// daylight m = 0.86, gives the absorption a for a scattering s. Along a ray, a and most of s is
// lost.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "color/sun_water.h"

namespace axial::color {

// A place in the row of types I, IA, IB, II, III, 1C, 3C, 5C, 7C, 9C: 0 is I, 2.5 is between IB and
// II.
using WaterType = double;

// The type of a name as "jerlov-IB". Throws an Error for another name.
WaterType parse_water_type(const std::string& name);

// The name of the nearest type, as parse_water_type() reads it.
std::string name_of(WaterType type);

// What kind of water loses the light as the channels that are determined say. The standard
// deviations contain those of the channels and the unknown scattering.
struct Daylight {
  WaterType type = 0;              // the one that agrees best
  std::array<Estimate, 3> losses;  // K_d of R G B [1/m]
  std::array<Estimate, 3> beams;   // loss along a ray of R G B [1/m]
};

// The mean of all types and scatterings, each weighted by how well it agrees with the channels.
// The table and a camera's channels agree to 10 % and 0.03 /m; scattering is that which is usual
// for the type within a factor of 2. `known`: the type, if it is known. Then no channel need be
// determined; otherwise empty if none is.
std::optional<Daylight> daylight_of(const SunWater& water, std::optional<WaterType> known);

// Takes the loss from `daylight` for channels that are not determined, and marks them as determined
// and assumed. Their veil B is 0, because it is not known. Channels of which the veil hides nearly
// all light of the surface (SunChannel::direct below kLeastDirect) stay as they are.
void assume(const Daylight& daylight, SunWater& water);

// Sets SunChannel::daylight of determined channels, so that J is the light that each surface has at
// the median height of the points. Heights are those of the observations.
void remove_daylight_loss(const Daylight& daylight, const Observations& observations,
                          SunWater& water);

}  // namespace axial::color
