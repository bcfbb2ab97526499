// SPDX-License-Identifier: GPL-3.0-or-later
// Checks, with the tracks alone, whether port, lens, scale and poses belong together.
//
// With the right cameras the rays of a point meet, up to the noise of the observations. With
// another port, lens or scale the rays usually miss one another by far more.
//
// Tracks do not show a change that moves images by less than the noise. A flat port close to the
// lens before a distant scene gives nearly the same photographs at any scale of the poses, and so
// does a dome whose centre is at the lens. A port and a scene that are both twice as large always
// give the same photographs. Tracks show nothing about photographs other than the photographs in
// which they were found. Poses may come from photographs in air and be used with photographs
// under water.
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

// The bundle with the change. Cameras that the change does not apply to stay as they are. A change
// of the scale moves poses and points.
Bundle changed(const Bundle& bundle, const PortChange& change);

// The changes that apply to the bundle's cameras and correspond to common errors of users, the
// likelier ones first.
std::vector<PortChange> likely_changes(const Bundle& bundle);

// Triangulates the points of the bundle anew and returns the median reprojection error [px] of
// all observations. Infinite if the bundle has no observations.
double track_residual(Bundle bundle);

struct PortCheck {
  std::size_t points = 0, observations = 0;
  double noise = 0;          // [px], expected for right cameras
  double residual = 0;       // [px], with the cameras as they are
  double in_air = 0;         // [px], without ports
  PortChange best;           // the single change that explains the tracks best
  double best_residual = 0;  // [px], with `best`

  // False: too few points or observations for a conclusion.
  bool tells() const { return points >= 15 && observations >= 60; }
  // The residual is at most three times the expected noise: with the ports, and in air.
  bool fits() const { return residual <= 3 * noise; }
  bool fits_in_air() const { return in_air <= 3 * noise; }
  // The change `best` explains the tracks clearly better than the given cameras.
  bool explained() const { return best_residual < 0.6 * residual; }
};

// Compares the bundle with the bundles of likely_changes(). `claimed_errors`: for each point the
// mean error [px] that the model states, 0 where it states none. The expected noise is their
// median, but at least 0.5 px: detectors locate features in underwater photographs no more
// precisely, and a model that states smaller errors is not tested more strictly. If the bundle
// fits, no changes are tried.
PortCheck check_ports(const Bundle& bundle, std::span<const double> claimed_errors);

// The cause in words, such as "the water's index n_water 1.49 (1.333 fits)". `bundle` is the bundle
// before the change.
std::string cause_of(const PortChange& change, const Bundle& bundle);

// What the user can do about the change. The text is a part of a sentence.
std::string advice_for(const PortChange& change);

}  // namespace axial::pose
