// SPDX-License-Identifier: GPL-3.0-or-later
// The seabed as one triangle mesh: a rough floor with boulders, mushroom rocks, arches and thin
// tubes on it. The world frame is in metres, with z upwards.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulate/blob.h"
#include "simulate/tube.h"

namespace axial::simulate {

// The height of the floor [m] is the sum of noise, a bowl and ripples. The first octave of the
// noise has the wavelength `wavelength` and the height `height`. Each further octave has half the
// wavelength and half the height of the octave before. The bowl rises by `bowl_height` between the
// horizontal distances `bowl_from` and `bowl_to` [m] from the world's origin.
//
// If `layer` is positive, the floor is bedded rock with a ledge at the end of each layer. The
// layers fall by dip.x metres per metre along x and by dip.y metres per metre along y.
struct Floor {
  std::uint32_t seed = 1;
  double wavelength = 2.0;                             // [m]
  double height = 0.4;                                 // height of the first octave [m]
  double bowl_from = 1, bowl_to = 2, bowl_height = 0;  // [m]; bowl_height 0: no bowl
  double layer = 0;                                    // thickness of a layer [m]; 0: no layers
  Eigen::Vector2d dip{0, 0};                           // used only if `layer` is positive
  double ripple_height = 0;    // height of sand ripples, from trough to crest [m]; 0: none
  double ripple_length = 0.2;  // distance of ripple crests, mostly along x [m]

  // The height (z) [m] of the floor at (x, y) [m].
  double at(double x, double y) const;
};

// A rectangular patch on which everything grew upwards. The growth falls from `height` to 0 in a
// strip of the width `edge` around the border of the rectangle. Lengths are metres.
struct Growth {
  Eigen::Vector2d centre{0, 0}, half{0, 0};  // the middle of the patch, and half of its sides
  double height = 0;
  double edge = 0.01;  // above 0, at most twice the shorter one of `half`

  // The growth [m] at (x, y) [m].
  double at(double x, double y) const;
};

// The parts from which terrain_mesh() builds the seabed.
struct Terrain {
  Floor floor;
  std::vector<Blob> blobs;
  std::vector<Arch> arches;
  std::vector<Tube> tubes;  // thin structures (TriangleMesh::thickness)
  double cell = 0.01;       // distance between vertices [m]
  // The area whose vertices are `cell` apart is |x| <= half_width, |y| <= half_height [m].
  double half_width = 4;
  double half_height = 3;
  double skirt = 10;   // width of a border with coarser cells around this area [m]
  Growth growth = {};  // of the whole mesh
  double relief = 1;   // factor of the z of all vertices of the mesh
};

// Returns the mesh of the whole terrain in the world frame, without most of the parts that are
// buried in other parts.
TriangleMesh terrain_mesh(const Terrain& terrain);

}  // namespace axial::simulate
