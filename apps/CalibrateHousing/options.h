// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/program.h"
#include "calibrate/advice.h"
#include "pose/free_numbers.h"

struct Options {
  axial::ParsedOptions parsed;
  std::vector<std::filesystem::path> input;  // photographs, and folders of them
  std::filesystem::path lens;                // COLMAP cameras or calibration.yaml
  std::filesystem::path housing;             // housing file or calibration.yaml; empty: the lens's
  std::string port;                          // its name there; empty: the camera's
  axial::calibrate::Board board;
  int bit_depth = 0;        // of 16-bit photographs; 0: found
  std::string refine_list;  // see pose/free_numbers.h; empty: what the kind of port has
  axial::pose::Sigmas sigmas;
  axial::calibrate::CalibrateOptions calibrate;
  axial::calibrate::Limits limits;
  std::filesystem::path output;                      // housing file
  std::filesystem::path calibmar, report, coverage;  // empty: not written
};

// Parses and checks the command line; what is left to do is in `parsed.run`.
Options parse_command_line(int argc, const char* const* argv);
