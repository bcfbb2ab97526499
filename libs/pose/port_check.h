// SPDX-License-Identifier: GPL-3.0-or-later
// Whether port, lens, scale and poses belong together: what the tracks say.
//
// What tracks can tell: with the right camera the rays of a point meet, to the noise of the
// observations. With another port, lens or scale they miss one another, mostly by far more.
// What they cannot tell: where a change moves images by less than the noise, nothing is said. A
// port close to the lens before a distant scene gives nearly the same photographs at any scale of
// the poses, and so does a dome around the lens. A port and a scene that are both twice as large
// give the same, always. And tracks say nothing about photographs other than those they were found
// in: poses may come from photographs in air, and go with the photographs under water.
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
    // Cameras in air get a thin port at the lens, which needs no dimensions; or, with another
    // `value` than 1, the focal length times `value`, which is nearly the same.
    thin_port,
    index,        // that of the water becomes `value`
    distance,     // of a flat port, times `value`
    normal,       // of a flat port, becomes the optical axis
    centre,       // of a dome, comes to the lens
    scale,        // of the poses, times `value`
    focal,        // focal lengths, times `value`
    focal_in_air  // the same, and cameras in air
  };
  Of of = Of::nothing;
  double value = 1;
};

// The bundle with the change. What a camera does not have does not change. Points go with the
// scale.
Bundle changed(const Bundle& bundle, const PortChange& change);

// The changes that make a difference to the bundle's cameras: causes that errors of users have, the
// likelier ones first.
std::vector<PortChange> likely_changes(const Bundle& bundle);

// The points triangulated anew among the cameras as they are: median reprojection error [px].
// Infinite where it has no observations.
double track_residual(Bundle bundle);

struct PortCheck {
  std::size_t points = 0, observations = 0;
  double noise = 0;     // [px], what would be expected
  double residual = 0;  // [px], of the cameras as they are
  double in_air = 0;    // [px], without ports
  PortChange best;      // the single change that brings the residual down most
  double best_residual = 0;

  // Too few observations say nothing.
  bool tells() const { return points >= 15 && observations >= 60; }
  // Observations scatter by less than three times the noise that is expected.
  bool fits() const { return residual <= 3 * noise; }
  bool fits_in_air() const { return in_air <= 3 * noise; }
  // The change explains the tracks clearly better than what was given.
  bool explained() const { return best_residual < 0.6 * residual; }
};

// `claimed_errors`: mean errors [px] of points that the model itself states, 0 where it states
// none. Their median is the noise to expect, at least half a pixel: detectors place features no
// better than that in photographs under water, and models that state less leave the rest of the
// doubt to the lens.
PortCheck check_ports(const Bundle& bundle, std::span<const double> claimed_errors);

// "the index of the water 1.49 (1.333 fits)" and the like, of `bundle` as it was before the change.
std::string cause_of(const PortChange& change, const Bundle& bundle);

// What to do about it, a sentence.
std::string advice_for(const PortChange& change);

}  // namespace axial::pose
