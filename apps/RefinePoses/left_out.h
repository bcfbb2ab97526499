// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs of COLMAP's database to which COLMAP gave no pose: the option --database.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/colmap/colmap.h"
#include "pose/refine.h"
#include "pose/registration/feature_matches.h"

namespace axial::apps {

// A photograph without a pose.
struct Unregistered {
  std::string name;
  std::string reason;  // with numbers
};

// The photographs of a database beside those of a model.
struct LeftOutPhotographs {
  // The index in ColmapModel::images of the first photograph without a pose. All that follow have
  // no pose either.
  std::size_t first = 0;
  std::vector<Unregistered> unusable;  // photographs that are not in the model: without a lens
  pose::FeatureMatches matches{{}};    // of all images of the model

  // Whether a photograph of the database has no pose in `model`, the result of add_left_out().
  bool any(const io::ColmapModel& model) const {
    return first < model.images.size() || !unusable.empty();
  }
};

// Adds the photographs of the database that `model` does not have, with their features and cameras,
// and gives the features of all photographs their sizes.
// Their poses have no meaning. `lenses`: as for pose::to_bundle(). Error that names the file for a
// database that cannot be read, that lacks a photograph of the model, or that has other features of
// it.
LeftOutPhotographs add_left_out(const std::filesystem::path& database,
                                std::span<const io::ColmapCamera> lenses, io::ColmapModel& model);

// What register_left_out() did, with names of photographs.
struct Registered {
  std::vector<std::string> names;            // that got a pose
  std::vector<Unregistered> left_out;        // that COLMAP left out, and that got no pose
  std::size_t observations = 0, points = 0;  // that were added to the tracks
};

// Gives poses to photographs that COLMAP left out (pose::register_photographs()), after a
// refinement with the poses that COLMAP found. `model` is the result of add_left_out(), and
// `bundle` the bundle of it (pose::to_bundle()). Afterwards `model` is in metres, as far as
// `options` determine the scale, has the new poses, observations and points besides its own
// observations, and contains no photograph without a pose. New points are grey. `options`: known
// lengths that cannot be used are left out. `context` gets lines about the progress.
Registered register_left_out(io::ColmapModel& model, const LeftOutPhotographs& left_out,
                             pose::Bundle bundle, pose::RefineOptions options,
                             const Context& context);

// Logs how many photographs were registered, and warns of each that was not, with the reason.
void log_registered(const Registered& registered);

}  // namespace axial::apps
