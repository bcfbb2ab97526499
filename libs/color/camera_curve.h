// SPDX-License-Identifier: GPL-3.0-or-later
// The curve of a camera, from photographs whose exposures are known: with the right curve, twice
// the exposure gives twice the light, and the light of one point agrees between photographs.
#pragma once

#include <optional>

#include "color/exposure.h"

namespace axial::color {

// spread_of() the model that is fitted to a part of the points, 500 to 1000 of them, after their
// light was divided by the exposures. Without a light, of the model with the smaller spread.
double spread_with(const Exposures& exposures, const Observations& observations,
                   const Transfer& transfer, std::optional<Light> light);

struct CameraCurve {
  Transfer transfer;
  double spread = 0;        // spread_with() this curve
  double spread_first = 0;  // spread_with() the curve with which the search began
  // Whether the photographs tell the curve: curves whose power is lower or higher by a factor of
  // 1.2 give a spread that is larger by 15 %. If not, `transfer` is the curve with which the search
  // began.
  bool is_told = false;
};

// The curve value = light^(1/G), with G from 1 to 3 to two digits after the point, that has the
// least spread_with() the exposures. `from`, the curve by which the observations have their light,
// stays if its spread is at most a tenth larger. Without a light, daylight is tried first, and
// lamps only if the spread is above 0.2, because their model takes ten times as long. The light of
// an observation, which is a mean, is converted as if it were the light of one pixel.
CameraCurve find_curve(const Exposures& exposures, const Observations& observations,
                       const Transfer& from, std::optional<Light> light);

}  // namespace axial::color
