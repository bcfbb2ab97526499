// SPDX-License-Identifier: GPL-3.0-or-later
// A known change between two surveys of the same seabed.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "simulate/presets/preset.h"

namespace axial::simulate {

// Turns a survey into a second one after a change, with other views. The world frame is the same.
// - One of the first `boulders` blobs of the terrain moves to another place. It keeps its height
//   above the floor and its attitude.
// - Everything within a patch of 1 m x 1 m grows upwards by 20 mm (Terrain::growth).
// The boulder, its new place and the patch are near the middle, where many views overlap, and as
// far from each other and from other large bodies as possible. They follow from the terrain, and
// the views from `seed`. Error if none of these blobs is near the middle.
// Precondition: the terrain has `boulders` blobs, and the views are those of add_two_rows().
void change_survey(Preset& preset, int boulders, std::uint32_t seed);

struct ChangedPart {
  double volume = 0;      // [m^3]
  double area = 0;        // of the ground that changed, on the map [m^2]
  Eigen::Vector2d place;  // the middle of the patch, the centre of the boulder [world, m]
};

struct ChangeTruth {
  ChangedPart gone, came;  // of the boulder, at its old and at its new place
  ChangedPart patch;       // of the growth
};

// What changed before a second survey. The volumes are those between the highest surfaces of both
// surveys on each vertical line. So the hidden space below an overhanging side of the boulder
// belongs to its volume, as in a map of heights, and the part of the boulder below the ground, and
// under other bodies, does not.
// The volume of the boulder is a sum over vertical lines in the middles of squares of 4 mm, times
// the scale of the scene. Precondition: preset.moved is set.
ChangeTruth true_change(const Preset& preset);

}  // namespace axial::simulate
