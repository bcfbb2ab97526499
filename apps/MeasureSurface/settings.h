// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "base/program/program.h"
#include "map/map_place.h"

namespace axial::apps {

struct Settings {
  std::filesystem::path mesh, areas;
  std::filesystem::path earlier;   // the mesh of an earlier survey in the same frame; empty: none
  bool allow_other_place = false;  // CompareOptions::allow_other_place
  map::PlaceOptions place;
  std::filesystem::path output;  // the names of the tables without ".csv" and ".gpkg"
  double length_sigma = 0;       // of lengths, as a share; 0: not known
};

struct Options {
  ParsedOptions parsed;
  Settings settings;
};

// Parses and checks the command line. Error for an unknown option, a missing file and a value out
// of range.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
