// SPDX-License-Identifier: GPL-3.0-or-later
// Fusion of a project's final depth maps, in one piece or of one part.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cloud/fuse.h"
#include "densify/existing_maps.h"
#include "densify/memory_plan.h"
#include "densify/project.h"
#include "io/ply/ply.h"
#include "survey/image_store.h"

namespace axial::densify {

// Numbers of points.
struct CloudCounts {
  std::size_t points = 0;   // in the cloud
  std::size_t of_two = 0;   // of these: points that are supported by only two depth maps
  std::size_t removed = 0;  // points that are left out because they are outside the region

  void add(const CloudCounts& more) {
    points += more.points;
    of_two += more.of_two;
    removed += more.removed;
  }
};

// The arguments that all parts share. The referenced objects must outlive it.
struct FusionRun {
  const Project& project;
  const Settings& settings;
  const MemoryPlan& plan;
  const ExistingMaps& existing;
  survey::ImageStore& images;
};

// The views of Project::references, in the same order.
std::vector<cloud::FusionView> views_to_fuse(const Project& project);

// Reads the final map of an image. A map without normals stays so: fusion estimates them.
DepthMap load_final_map(const FusionRun& run, std::size_t image);

// Fuses `views`. Points outside the region of interest are left out if Settings::crop_to_roi asks
// for it. `part`: empty for the whole cloud. `max_maps`: FuseOptions::max_maps. `title`: shown with
// the progress. Passes the points to `sink` and returns their numbers. Throws the Errors of
// cloud::fuse().
CloudCounts fuse_maps(const FusionRun& run, const std::vector<cloud::FusionView>& views,
                      const std::optional<cloud::FusionPart>& part, std::size_t max_maps,
                      const std::string& title, const cloud::CloudSink& sink);

// The properties of the written cloud. Precondition: neither colours nor normals are estimated from
// the whole cloud.
io::CloudLayout layout_of(const Settings& settings);

// Logs the numbers of points outside the region and of points of two maps. Unless Settings::report
// is empty, adds an entry "fusion" to this file, which must exist.
void report_counts(const Settings& settings, const CloudCounts& counts);

}  // namespace axial::densify
