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

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pose/bundle/bundle.h"

namespace axial::diagnosis {

// One change to the measured values of a bundle's cameras, or to the bundle's scale, with the cause
// of misfit that it corrects. Cameras to which the change does not apply stay as they are.
struct PortChange {
  enum class Of {
    nothing,
    port_left_out,  // all ports are left out: cameras in air
    thin_port,      // cameras in air get a flat port at the lens, or focal lengths as behind one
    index,          // of the water
    distance,       // of flat ports
    normal,         // of flat ports: becomes the optical axis
    centre,         // of domes: moves to the camera centre
    scale,          // of poses and points, not of ports
    focal,          // focal lengths
    focal_in_air    // focal lengths, and all ports are left out
  };
  Of of = Of::nothing;
  std::function<void(pose::Bundle& bundle)> apply;  // empty: no change
  // Parts of sentences: the cause, such as "the water's index n_water 1.49 (1.333 fits)", and what
  // the user can do.
  std::string cause = "no single change explains the errors";
  std::string advice =
      "check lens, port and scale; RefinePoses can adjust values that were measured with low "
      "precision";
};

// Returns the bundle with the change.
pose::Bundle changed(const pose::Bundle& bundle, const PortChange& change);

// The changes that apply to the bundle's cameras and correspond to common errors of users, in the
// order of decreasing likelihood. If ports differ, the first camera with a port decides which
// changes apply.
std::vector<PortChange> likely_changes(const pose::Bundle& bundle);

// Triangulates the points of the bundle anew and returns the median reprojection error [px] of all
// observations. An observation of a point without image counts as infinite. Infinite if the bundle
// has no observations.
double track_residual(pose::Bundle bundle);

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
PortCheck check_ports(const pose::Bundle& bundle, std::span<const double> claimed_errors);

}  // namespace axial::diagnosis
