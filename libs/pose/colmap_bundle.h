// SPDX-License-Identifier: GPL-3.0-or-later
// From a COLMAP model of photographs taken through a port to a bundle, and back.
#pragma once

#include <span>

#include "io/colmap.h"
#include "io/housing.h"
#include "pose/bundle.h"

namespace axial::pose {

// A bundle and what it takes to make a COLMAP model of it again.
struct ColmapBundle {
  Bundle bundle;
  std::vector<io::ColmapCamera> lenses;  // per bundle camera: in air; ids are the bundle's, from 1
  std::vector<std::string> ports;        // per bundle camera: its port's name
  std::size_t unseen = 0;                // observations left out: the lens images nothing there
};

// Poses, points and tracks of `model`, whatever lenses it believes in; in their place the `lenses`
// in air, by camera id, or a single one for all cameras of its size, behind their ports of
// `housing`. Observations are moved to the pixels of a distortion-free lens that holds the whole
// image. Error for a camera without a lens, or of another size than its lens, and for one behind a
// water surface.
ColmapBundle to_bundle(const io::ColmapModel& model, std::span<const io::ColmapCamera> lenses,
                       const io::Housing& housing);

// Moves the observations to where the lenses take the distortion away at the focal lengths that the
// cameras have now. Until then focal lengths move them to first order, from where they were placed.
void place_again(ColmapBundle& bundle, const io::ColmapModel& model);

// Which cameras the poses of a model that carries ports were solved with: the RMS [px] of its own
// tracks with the cameras behind their ports, and in air. 0 where a model has no tracks.
struct PortFit {
  double behind_ports = 0, in_air = 0;
};
PortFit port_fit(const io::ColmapModel& model);

// `model` with the bundle's poses, points, tracks and mean errors, the in-air lenses and the ports.
// Images without observations are left out.
io::ColmapModel to_model(const ColmapBundle& bundle, const io::ColmapModel& model);

// The ports where the bundle has them now, by camera id; one that several cameras share, and that
// has been adjusted, becomes one for each.
io::Housing to_housing(const ColmapBundle& bundle, const io::Housing& measured);

}  // namespace axial::pose
