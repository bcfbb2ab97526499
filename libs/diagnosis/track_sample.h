// SPDX-License-Identifier: GPL-3.0-or-later
// A bounded part of a model's tracks, for checks whose cost must not grow with the model.
#pragma once

#include "io/colmap/colmap.h"
#include "pose/bundle/adjust_options.h"

namespace axial::diagnosis {

// Whether a sample has enough images and points for a check: 3 and 20.
template <class Sample>
bool is_enough(const Sample& sample) {
  return sample.images.size() >= 3 && sample.points.size() >= 20;
}

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

// A sample of a bundle: at most 40 images that are connected by common points, and at most
// `most_points` points, those with the most observations in these images, two at least. The images
// are found by a breadth-first search that begins at the middle of the bundle's list of images.
// With `behind_ports`, only images whose camera is behind a port are taken. Images and cameras
// without observations in the sample are left out. So indices in the sample differ from those in
// `bundle`. The sample is empty if no image can be taken.
pose::Bundle sample_bundle(const pose::Bundle& bundle, std::size_t most_points, bool behind_ports);

// The length from the first image to the image farthest from it, which an adjustment of a sample
// holds nearly constant. Nothing if all centres are at one place.
std::vector<pose::KnownDistance> held_length(const pose::Bundle& part);

}  // namespace axial::diagnosis
