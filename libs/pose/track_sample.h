// SPDX-License-Identifier: GPL-3.0-or-later
// A bounded part of a model's tracks, for checks that must not cost more the larger the model is.
#pragma once

#include "io/colmap.h"
#include "pose/bundle.h"

namespace axial::pose {

struct SampleLimits {
  std::size_t points = 2000;
  std::size_t images = 300;
  std::size_t track = 8;   // observations of a point
  std::size_t seeds = 20;  // images, evenly spaced in the model's order, whose points are taken
};

// Points that two images or more see, their observations, and the images and cameras of these. Each
// image counts once in a track. Time is linear in the model's images and points, and the same model
// gives the same sample. A model without tracks gives an empty one.
io::ColmapModel sample_tracks(const io::ColmapModel& model, const SampleLimits& limits = {});

// The same of a bundle: images that see points in common, beginning with the one in the middle of
// the bundle's order. Only images whose camera is behind a port, if `behind_ports` says so.
Bundle sample_bundle(const Bundle& bundle, const SampleLimits& limits, bool behind_ports);

}  // namespace axial::pose
