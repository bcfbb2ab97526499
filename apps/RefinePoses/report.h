// SPDX-License-Identifier: GPL-3.0-or-later
// The result of a refinement, for the log and as JSON.
#pragma once

#include <string>
#include <vector>

#include "pose/refine.h"

namespace axial::apps {

// The RMS errors of one image [px], before and after.
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
  // Input that was given but not used, one entry for each line. `scale_lost`: the known scale was
  // not used. Then the scale counts as not known, even where refraction determines it.
  std::vector<std::string> unused;
  bool scale_lost = false;
};

// The table of errors for the log, one entry for each line.
std::vector<std::string> error_lines(const Results& results);

// The standard deviations of numbers and lengths, one entry for each line.
std::vector<std::string> uncertainty_lines(const Results& results, const pose::Uncertainty& known);

// Numbers that are not known are null. Without `known` all standard deviations are null, and the
// report says that they are missing.
std::string report_json(const Results& results, const pose::Uncertainty* known);

}  // namespace axial::apps
