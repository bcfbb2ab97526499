// SPDX-License-Identifier: GPL-3.0-or-later
// A bounded part of a model's tracks, for checks whose cost must not grow with the model.
#pragma once

#include "io/colmap/colmap.h"
#include "pose/bundle.h"

namespace axial::pose {

struct SampleLimits {
  std::size_t points = 2000;  // largest number of points
  std::size_t images = 300;   // largest number of images
  std::size_t track = 8;      // largest number of observations of a point
  // The points are taken from this many images, evenly spaced in the model's order. Each of these
  // images gives at most points / seeds points.
  std::size_t seeds = 20;
};

// Returns a sample of the points that two or more images observe, with their observations and the
// images and cameras of these observations, within `limits`. A track has at most one observation in
// each image. The time is linear in the numbers of images and points of the model. The same model
// gives the same sample, and a model without tracks gives an empty sample.
io::ColmapModel sample_tracks(const io::ColmapModel& model, const SampleLimits& limits = {});

// A sample of a bundle: images that are connected by common points, and the points with the most
// observations in these images, two at least. The images are found by a breadth-first search that
// begins at the middle of the bundle's list of images. `limits.seeds` and `limits.track` are not
// used. With `behind_ports`, only images whose camera is behind a port are taken. Images and
// cameras without observations in the sample are left out. So indices in the sample differ from
// those in `bundle`. The sample is empty if no image can be taken.
Bundle sample_bundle(const Bundle& bundle, const SampleLimits& limits, bool behind_ports);

}  // namespace axial::pose
