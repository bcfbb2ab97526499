// SPDX-License-Identifier: GPL-3.0-or-later
// What a refinement came to, for people and for programs.
#pragma once

#include <span>
#include <string>

#include "pose/refine.h"

// The errors of one image [px], before and after.
struct ImageErrors {
  std::string name;
  std::size_t observations = 0;
  double rms_before = 0, rms_after = 0;
};

std::vector<ImageErrors> errors_by_image(const axial::pose::Bundle& before,
                                         const axial::pose::Bundle& after);

// Tables for the log: one line each.
std::vector<std::string> report_lines(const axial::pose::RefineReport& report,
                                      std::span<const ImageErrors> images,
                                      const axial::pose::Bundle& bundle,
                                      std::span<const std::string> ports,
                                      const axial::pose::AdjustOptions& options);

std::string report_json(const axial::pose::RefineReport& report,
                        std::span<const ImageErrors> images, const axial::pose::Bundle& bundle,
                        std::span<const std::string> ports,
                        const axial::pose::AdjustOptions& options);
