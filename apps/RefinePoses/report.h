// SPDX-License-Identifier: GPL-3.0-or-later
// What a refinement came to, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "pose/refine.h"

// The errors of one image [px], before and after.
struct ImageErrors {
  std::string name;
  std::size_t observations = 0;
  double rms_before = 0, rms_after = 0;
};

std::vector<ImageErrors> errors_by_image(const axial::pose::Bundle& before,
                                         const axial::pose::Bundle& after);

// What a refinement came to, without how well it is known.
struct Results {
  const axial::pose::RefineReport& report;
  std::vector<ImageErrors> images;
  const axial::pose::Bundle& bundle;
  std::vector<std::string> ports;  // one a camera
  const axial::pose::AdjustOptions& options;
  // What was given and is not used, a line each, and whether the scale is among it: then it counts
  // as not known, whatever refraction tells of it.
  std::vector<std::string> unused;
  bool scale_lost = false;
};

// The table of errors for the log: one line each.
std::vector<std::string> error_lines(const Results& results);

// How well the numbers and lengths are known, one line each.
std::vector<std::string> uncertainty_lines(const Results& results,
                                           const axial::pose::Uncertainty& known);

// null for what is not known. Without `known`, standard deviations are null and said to be missing.
std::string report_json(const Results& results, const axial::pose::Uncertainty* known);
