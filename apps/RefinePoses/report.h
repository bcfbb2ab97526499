// SPDX-License-Identifier: GPL-3.0-or-later
// Reports the result of a refinement, as lines for the log and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control_report.h"
#include "left_out.h"
#include "pose/adjust/uncertainty.h"
#include "pose/refine.h"

namespace axial::apps {

// The RMS reprojection errors of one image [px], before and after the refinement.
struct ImageErrors {
  std::string name;
  std::size_t observations = 0;
  double rms_before = 0, rms_after = 0;
};

std::vector<ImageErrors> errors_by_image(const pose::Bundle& before, const pose::Bundle& after);

// The result of a refinement without its standard deviations.
struct Results {
  const pose::RefineReport& report;
  std::vector<ImageErrors> images;
  const pose::Bundle& bundle;
  std::vector<std::string> ports;  // one for each camera
  const pose::AdjustOptions& options;
  // unused: input that was given but not used, as lines. scale_lost: the known scale is among this
  // input. In this case the scale is reported as not known, even if refraction determines it.
  std::vector<std::string> unused;
  bool scale_lost = false;
  bool is_other_kind = false;                  // the photographs fit another kind of port better
  const Registered* registered = nullptr;      // with --database
  std::optional<ControlResults> control = {};  // with --targets, once standard deviations are known
};

// Returns the table of errors as lines for the log.
std::vector<std::string> error_lines(const Results& results);

// Returns the line for the log that says how far known positions lie from the cameras, and the
// standard deviation of their coordinates. No line if no position was used.
std::vector<std::string> position_lines(const pose::RefineReport& report);

// Returns the warnings about known positions that deviate more than their stated standard
// deviations let expect, or that made the reprojection errors larger.
std::vector<std::string> position_warnings(const pose::RefineReport& report);

// Returns the free numbers, their stated values, what decided about them, and the standard
// deviation of lengths as lines for the log. `known`: the standard deviations of the refinement.
std::vector<std::string> uncertainty_lines(const Results& results, const pose::Uncertainty& known);

// Returns a warning if no length or position is known, poses are adjusted, and lengths are known to
// more than 2 % or not at all.
std::optional<std::string> scale_warning(const Results& results, const pose::Uncertainty& known);

// Returns the line for the log about Uncertainty::shape_sigma.
std::string shape_line(const pose::Uncertainty& known);

// Returns a warning if the standard deviation of the cameras' centres relative to each other
// (Uncertainty::shape_sigma) is above 0.2 % of the distance of the points and above 1/2000 of the
// length of the survey.
std::optional<std::string> shape_warning(const Results& results, const pose::Uncertainty& known);

// Returns the line for the log about Uncertainty::depth_sigma, and a warning if it is above 0.3 %.
std::string depth_line(const pose::Uncertainty& known);
std::optional<std::string> depth_warning(const pose::Uncertainty& known);

// Returns the report as JSON. Numbers that are not known are null. If `known`, the standard
// deviations of the refinement, is null, all standard deviations are null, and the report says that
// they are missing.
std::string report_json(const Results& results, const pose::Uncertainty* known);

}  // namespace axial::apps
