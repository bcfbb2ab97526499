// SPDX-License-Identifier: GPL-3.0-or-later
// Converts a COLMAP model of photographs taken through a port to a bundle, and back.
#pragma once

#include <span>

#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "pose/bundle.h"

namespace axial::pose {

// A bundle, and the parts of a COLMAP model that the bundle itself does not hold.
struct ColmapBundle {
  Bundle bundle;
  std::vector<io::ColmapCamera> lenses;  // per bundle camera: the lens in air; ids count from 1
  std::vector<std::string> ports;        // per bundle camera: the name of its port
  std::size_t unseen = 0;                // observations left out: their lens has no direction there
};

// The bundle of the poses, points and tracks of `model`. The lenses of `model` are not used: each
// camera gets the lens in air of `lenses` with its id, or the only one if `lenses` holds one,
// behind its port of `housing`. Error for a camera without a lens, for a camera whose size differs
// from its lens, for a lens of a model that is not supported, for a port that is not defined, and
// for a camera behind a water surface.
ColmapBundle to_bundle(const io::ColmapModel& model, std::span<const io::ColmapCamera> lenses,
                       const io::Housing& housing);

// With which cameras the poses of a model with ports were computed: the RMS reprojection error [px]
// of its tracks with the cameras behind their ports, and with the same cameras in air. 0 where a
// model has no tracks.
struct PortFit {
  double behind_ports = 0, in_air = 0;
};
PortFit port_fit(const io::ColmapModel& model);

// `model` with the poses, points, tracks and mean reprojection errors of the bundle, its lenses in
// air and its ports. Images without observations are left out.
io::ColmapModel to_model(const ColmapBundle& bundle, const io::ColmapModel& model);

// The ports of the bundle as they are now, by camera id. A port that several cameras share, and
// that was adjusted, becomes one port for each camera.
io::Housing to_housing(const ColmapBundle& bundle, const io::Housing& measured);

}  // namespace axial::pose
