// SPDX-License-Identifier: GPL-3.0-or-later
// Targets, bars and control points of --targets, --bars and --control.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "control/control.h"
#include "pose/refine.h"
#include "scene/local_frame.h"
#include "targets/codes/family.h"

namespace axial::apps {

// The file of found targets in the output folder.
inline constexpr const char* kFoundTargets = "targets.json";

struct ControlOptions {
  std::filesystem::path targets, bars, control;  // files; empty: not given
  bool find = false;  // targets are found in the photographs below `images`
  std::filesystem::path images;
  std::string families = targets::kUsualFamilies;  // of targets that are found, as
                                                   // targets::parse_families() reads them
  std::string checks;  // labels and bars that are checks, separated by commas
  int epsg = 0;        // of the coordinates; 0: not given

  bool any() const { return find || !targets.empty(); }
};

// Throws an Error if options contradict each other.
void check(const ControlOptions& options);

// Reads the files. Errors name the file and the line. Notes about the files go to the log.
control::Control read_control(const ControlOptions& options);

// Known lengths and places that do not enter the adjustment. Their errors are reported.
struct ControlChecks {
  std::vector<pose::KnownDistance> distances;
  std::vector<pose::KnownPlace> places;
};

struct AddedControl {
  ControlChecks checks;
  double map_scale = 1;  // Control::map_scale if control points scale the model
  // A line for each bar, point or target that cannot be used.
  std::vector<std::string> unused;
};

// Adds the targets to the bundle, and bars and control points to `refine`: to `refine.adjust` those
// that are used. A control point whose label is no target, but the name of an image, is a camera
// centre: so depths of a gauge enter. Targets in photographs that the bundle does not have are not
// used. If two or more control points with x and y are used, all known distances, also those that
// `refine.adjust` has before, become lengths on the map (AddedControl::map_scale).
AddedControl add_control(const control::Control& control, pose::Bundle& bundle,
                         pose::RefineOptions& refine);

// The places [world] from which the local frame is chosen: those with x and y.
std::vector<Eigen::Vector3d> places_in_plan(const std::vector<pose::KnownPlace>& places);

// Moves places from the world to `frame`.
void enter(const LocalFrame& frame, std::vector<pose::KnownPlace>& places);

}  // namespace axial::apps
