// SPDX-License-Identifier: GPL-3.0-or-later
// The seabed as one triangle mesh: a rough floor with boulders, mushroom rocks, arches and thin
// tubes on it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulate/blob.h"
#include "simulate/tube.h"

namespace axial::simulate {

// Height of the floor over (x, y): octaves of noise from `wavelength` down, halving in length and
// in height, on a bowl that rises by `bowl_height` between `bowl_from` and `bowl_to` metres from
// the world's origin. With layers it is bedded rock: ledges where layers end, which rise by `dip`
// metres a metre along x and y.
struct Floor {
  std::uint32_t seed = 1;
  double wavelength = 2.0;  // [m]
  double height = 0.4;      // of the first octave [m]
  double bowl_from = 1, bowl_to = 2, bowl_height = 0;
  double layer = 0;  // thickness of a layer [m]; 0: none
  Eigen::Vector2d dip{0, 0};
  double ripple_height = 0;    // of sand ripples, from trough to crest [m]
  double ripple_length = 0.2;  // from crest to crest, along x for the most part [m]

  double at(double x, double y) const;
};

struct Terrain {
  Floor floor;
  std::vector<Blob> blobs;
  std::vector<Arch> arches;
  std::vector<Tube> tubes;  // thin: the mesh knows their thickness
  double cell = 0.01;       // distance between vertices [m]
  double half_width = 4;    // the part meshed at `cell`: |x| <= half_width, |y| <= half_height
  double half_height = 3;
  double skirt = 10;  // how far coarser cells continue beyond that [m]
  double relief = 1;  // all heights of the mesh times this
};

// The mesh of everything, without most of what is buried inside something else.
TriangleMesh terrain_mesh(const Terrain& terrain);

}  // namespace axial::simulate
