// SPDX-License-Identifier: GPL-3.0-or-later
// What became of targets, bars and control points: lines for the log, the report, and the file of
// places for later surveys.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "control.h"
#include "control/target_places.h"
#include "pose/control/control_fit.h"
#include "scene/local_frame.h"

namespace axial::apps {

// A bar or a control point beside the adjusted model.
struct BarResult {
  std::string name;
  pose::KnownFit fit;
  std::size_t photographs = 0;  // that show both ends
  bool check = false;
};
struct PointResult {
  std::string name;
  pose::PlaceFit fit;
  std::size_t photographs = 0;
  bool check = false;
};
struct ControlResults {
  std::size_t targets = 0, observations = 0;  // that the adjustment used
  double rms = 0;                             // reprojection error of the targets [px]
  std::string crs;                            // of the points: "EPSG:32617"; empty: not stated
  double map_scale = 1;                       // AddedControl::map_scale: of the lengths of bars
  std::vector<BarResult> bars;
  std::vector<PointResult> points;
  std::vector<std::string> left_out;  // lines about what was not used or is doubtful
};

// The results of an adjustment of `bundle` with `options`, which are in `frame`; the results are in
// the world. Checks that have no place any more are added to the lines that were left out.
ControlResults control_results(const pose::Bundle& bundle, const pose::AdjustOptions& options,
                               const LocalFrame& frame, ControlChecks checks,
                               std::vector<std::string> left_out);

// The table for the log.
std::vector<std::string> control_lines(const ControlResults& results);

// Returns warnings: lines that were left out, and bars and points, used or checks, that are off by
// more than three standard deviations.
std::vector<std::string> control_warnings(const ControlResults& results);

// The object "control" of the report.
nlohmann::ordered_json control_json(const ControlResults& results);

// The places of those of `targets` whose points are in the bundle, in the world, and their
// covariance.
control::TargetPlaces target_places(const pose::Bundle& bundle, const pose::AdjustOptions& options,
                                    const std::vector<pose::Target>& targets,
                                    const LocalFrame& frame);

}  // namespace axial::apps
