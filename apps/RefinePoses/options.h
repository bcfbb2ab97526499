// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/program/program.h"
#include "control.h"
#include "pose/adjust/free_numbers.h"
#include "pose/refine.h"
#include "rigs.h"
#include "scale_from.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  std::filesystem::path model;     // COLMAP folder
  std::filesystem::path lens;      // COLMAP cameras in air: a file or a model's folder
  std::filesystem::path housing;   // housing file; empty if usual_housing is not
  std::string usual_housing;       // "flat", "dome" or "unknown" instead of a file; else empty
  std::filesystem::path output;    // output folder
  std::filesystem::path database;  // COLMAP's; empty: photographs without a pose stay out
  std::filesystem::path effective_lens;  // file; empty: refines poses
  double scene_distance = 2;             // of effective_lens [m]
  bool underwater = false;               // also write the model for COLMAP-Underwater
  std::string poses = "adjust";          // "adjust" or "known"
  bool allow_missing = false;            // no error if the known scale cannot be used
  std::string scale_from;  // see scale_from.h; empty: refraction alone determines the scale
  ScaleSigma scale_sigma;
  ControlOptions control;
  std::vector<std::string> dropped_positions;  // lines of add_known() (scale_from.h)
  std::string refine_list = "auto";            // `refine` of pose::set_estimated_numbers()
  pose::Sigmas sigmas;
  RigInput rigs;
  pose::RefineOptions refine;
};

// Parses and checks the command line. Error for an unknown option and for a wrong value.
// `parsed.run` is false if nothing is left to do, for example after --help.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
