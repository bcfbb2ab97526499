// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/program/program.h"
#include "calibrate/advice.h"
#include "pose/adjust/free_numbers.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  std::vector<std::filesystem::path> input;  // files of photographs, or folders of them
  std::filesystem::path lens;                // COLMAP's cameras, or Calibmar's calibration.yaml
  std::filesystem::path housing;  // housing file or calibration.yaml; empty: the port in `lens`
  std::string port;  // name of the port in `housing`; empty: the port that the camera has there
  calibrate::Board board;
  int bit_depth = 0;        // number of bits that 16-bit photographs use; 0: detected
  std::string refine_list;  // `refine` of pose::set_free_numbers(); empty: pose::place_words()
  pose::Sigmas sigmas;
  calibrate::CalibrateOptions calibrate;
  calibrate::Limits limits;
  std::filesystem::path output;                      // the housing file to write
  std::filesystem::path calibmar, report, coverage;  // empty: not written
};

// Parses and checks the command line. Error for an unknown option and for a wrong value.
// `parsed.run` is false if nothing is left to do, for example after --help.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
