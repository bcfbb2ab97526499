// SPDX-License-Identifier: GPL-3.0-or-later
// A bounded part of a model's tracks, for checks whose cost must not grow with the model.
#pragma once

#include "io/colmap/colmap.h"
#include "pose/bundle.h"

namespace axial::pose {

struct SampleLimits {
  std::size_t points = 2000;
  std::size_t images = 300;
  std::size_t track = 8;  // observations of each point
  // The points are taken from this many images, evenly spaced in the model's order.
  std::size_t seeds = 20;
};

// A sample of the points that two images or more observe, with their observations, and the images
// and cameras of these observations. A track has at most one observation of each image. Runs in
// linear time in the model's images and points. The same model gives the same sample, and a model
// without tracks gives an empty sample.
io::ColmapModel sample_tracks(const io::ColmapModel& model, const SampleLimits& limits = {});

// A sample of a bundle: images that are connected by common points, and the points that the largest
// numbers of these images observe. The search for images begins in the middle of the bundle's order
// and goes outwards. `seeds` and `track` of the limits are not used. With `behind_ports`, only
// images whose camera is behind a port are taken.
Bundle sample_bundle(const Bundle& bundle, const SampleLimits& limits, bool behind_ports);

}  // namespace axial::pose
