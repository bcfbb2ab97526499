// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/program/program.h"
#include "targets/codes/family.h"

namespace axial::apps {

// Two targets and the distance between their centres.
struct Bar {
  std::size_t first = 0, second = 0;
  double length = 0;  // [m]
};

struct Options {
  ParsedOptions parsed;
  std::vector<std::filesystem::path> input;
  std::filesystem::path output, pictures, target_table;
  std::vector<targets::Family> families;
  std::vector<std::filesystem::path> control;  // files of known points and bars
  int epsg = 0;                                // of their coordinates; 0: not given
  std::filesystem::path print;                 // folder; not empty: plates are drawn
  std::vector<std::size_t> plates;             // numbers of the plates to draw
  std::vector<Bar> bars;                       // to draw
  double side = 0.1;                           // of a plate [m]
};

// The format of the file of targets, which the extension chooses.
enum class OutputFormat { json, gcp_list, markers };
OutputFormat format_of(const std::filesystem::path& output);

// Throws an Error for wrong options.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
