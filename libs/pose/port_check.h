// SPDX-License-Identifier: GPL-3.0-or-later
// Checks, with the tracks alone, whether port, lens, scale and poses belong together.
//
// With the right cameras, the rays of the observations of a point meet, up to the noise of the
// observations. With a wrong port, lens or scale, the rays usually miss one another by far more.
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

// One change to the measured values of a bundle's cameras, or to the bundle's scale.
struct PortChange {
  enum class Of {
    nothing,        // no change
    port_left_out,  // all ports are left out: cameras in air
    // If `value` is 1, cameras in air get a flat port of zero thickness that almost touches the
    // lens. Otherwise their focal lengths are multiplied by `value`, which has nearly the same
    // effect. In both cases the user need not state dimensions of a port.
    thin_port,
    index,        // refractive index of the water becomes `value`
    distance,     // distance of a flat port is multiplied by `value`
    normal,       // normal of a flat port becomes the optical axis
    centre,       // centre of a dome moves to the camera centre
    scale,        // lengths of poses and points are multiplied by `value`, those of ports are not
    focal,        // focal lengths are multiplied by `value`
    focal_in_air  // focal lengths are multiplied by `value`, and all ports are left out
  };
  Of of = Of::nothing;
  double value = 1;  // has no effect on the changes above that do not name it
};

// Returns the bundle with the change. Cameras to which the change does not apply stay as they are.
// A change of the scale moves poses and points.
Bundle changed(const Bundle& bundle, const PortChange& change);

// The changes that apply to the bundle's cameras and correspond to common errors of users, in the
// order of decreasing likelihood. If ports differ, the first camera with a port decides which
// changes apply.
std::vector<PortChange> likely_changes(const Bundle& bundle);

// Triangulates the points of the bundle anew and returns the median reprojection error [px] of all
// observations. An observation of a point without image counts as infinite. Infinite if the bundle
// has no observations.
double track_residual(Bundle bundle);

// The result of check_ports(). track_residual() is that of the bundle with the named cameras.
struct PortCheck {
  std::size_t points = 0, observations = 0;  // of the bundle
  double noise = 0;                          // track_residual() that right cameras would have [px]
  double residual = 0;                       // track_residual() with the cameras as they are [px]
  double in_air = 0;                         // track_residual() without ports [px]
  // The single change that explains the tracks best. Of several changes that explain them about
  // equally well, it is the likeliest. `nothing` if fits() is true, or if no change reduces the
  // residual.
  PortChange best;
  double best_residual = 0;  // track_residual() with `best` [px]

  // Whether there are enough points and observations for a conclusion.
  bool tells() const { return points >= 15 && observations >= 60; }
  // fits(): whether the tracks fit the cameras as they are. fits_in_air(): whether the tracks fit
  // the cameras without ports. Tracks fit if the residual is at most three times `noise`.
  bool fits() const { return residual <= 3 * noise; }
  bool fits_in_air() const { return in_air <= 3 * noise; }
  // Whether the change `best` explains the tracks clearly better than the given cameras.
  bool explained() const { return best_residual < 0.6 * residual; }
};

// Compares the bundle with the bundles of likely_changes(). `claimed_errors`: for each point the
// mean error [px] that the model states, or 0 if it states none. The order does not matter.
// PortCheck::noise is the median of `claimed_errors`, but at least 0.5 px, because detectors locate
// features in underwater photographs no more precisely. If the bundle fits, no changes are tried.
PortCheck check_ports(const Bundle& bundle, std::span<const double> claimed_errors);

// The cause of misfit that `change` corrects, in words, such as "the water's index n_water 1.49
// (1.333 fits)". `bundle` is the bundle before the change. The text is a part of a sentence.
std::string cause_of(const PortChange& change, const Bundle& bundle);

// What the user can do if `change` explains the tracks. The text is a part of a sentence.
std::string advice_for(const PortChange& change);

}  // namespace axial::pose
