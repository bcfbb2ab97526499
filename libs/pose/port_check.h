// SPDX-License-Identifier: GPL-3.0-or-later
// Checks, with the tracks alone, whether port, lens, scale and poses belong together.
//
// With the right cameras the rays of a point meet, up to the noise of the observations. With a
// wrong port, lens or scale the rays usually miss one another by far more.
//
// Tracks do not show a change that moves images by less than the noise. For example, a flat port
// close to the lens, with a distant scene, gives nearly the same photographs at any scale of the
// poses. So does a dome whose centre is at the lens. A port and a scene that are both twice as
// large always give the same photographs. Tracks also show nothing about other photographs than
// those in which they were found: poses may come from photographs in air and be used with
// photographs under water.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pose/bundle.h"

namespace axial::pose {

// One change to the cameras of a bundle, or to its scale.
struct PortChange {
  enum class Of {
    nothing,
    port_left_out,  // cameras in air
    // If `value` is 1, cameras in air get a flat port of zero thickness that almost touches the
    // lens. Otherwise their focal length is multiplied by `value`, which has nearly the same
    // effect. In both cases the user need not state dimensions of a port.
    thin_port,
    index,        // index of the water becomes `value`
    distance,     // distance of a flat port is multiplied by `value`
    normal,       // normal of a flat port becomes the optical axis
    centre,       // centre of a dome moves to the lens
    scale,        // lengths of poses and points are multiplied by `value`
    focal,        // focal lengths are multiplied by `value`
    focal_in_air  // as `focal`, and all ports are left out
  };
  Of of = Of::nothing;
  double value = 1;
};

// Returns the bundle with the change. Cameras to which the change does not apply stay as they are.
// A change of the scale moves poses and points.
Bundle changed(const Bundle& bundle, const PortChange& change);

// The changes that apply to the bundle's cameras and correspond to common errors of users, in the
// order of decreasing likelihood.
std::vector<PortChange> likely_changes(const Bundle& bundle);

// Triangulates the points of the bundle anew and returns the median reprojection error [px] of
// all observations. Infinite if the bundle has no observations.
double track_residual(Bundle bundle);

struct PortCheck {
  std::size_t points = 0, observations = 0;
  double noise = 0;          // track_residual() that right cameras would have [px]
  double residual = 0;       // track_residual() with the cameras as they are [px]
  double in_air = 0;         // track_residual() without ports [px]
  PortChange best;           // the single change that explains the tracks best
  double best_residual = 0;  // track_residual() with `best` [px]

  // Whether there are enough points and observations for a conclusion.
  bool tells() const { return points >= 15 && observations >= 60; }
  // Whether the tracks fit the cameras with their ports, and without ports: the residual is at most
  // three times the expected noise.
  bool fits() const { return residual <= 3 * noise; }
  bool fits_in_air() const { return in_air <= 3 * noise; }
  // Whether the change `best` explains the tracks clearly better than the given cameras.
  bool explained() const { return best_residual < 0.6 * residual; }
};

// Compares the bundle with the bundles of likely_changes(). `claimed_errors`: for each point the
// mean error [px] that the model states, or 0 if it states none. The expected noise is the median
// of `claimed_errors`, but at least 0.5 px, because detectors locate features in underwater
// photographs no more precisely. If the bundle fits, no changes are tried.
PortCheck check_ports(const Bundle& bundle, std::span<const double> claimed_errors);

// The cause in words, such as "the water's index n_water 1.49 (1.333 fits)". `bundle` is the bundle
// before the change.
std::string cause_of(const PortChange& change, const Bundle& bundle);

// What the user can do about the change. The text is a part of a sentence.
std::string advice_for(const PortChange& change);

}  // namespace axial::pose
