// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>

#include "base/program.h"

namespace axial::apps {

struct Settings {
  std::filesystem::path mesh, areas;
  std::filesystem::path map;          // a map of MapSurface; empty: not given
  std::filesystem::path output;       // the names of the tables without ".csv" and ".gpkg"
  std::optional<Eigen::Vector3d> up;  // in the world, without a map; empty: z
  int epsg = 0;                       // without a map; 0: no coordinate reference system
  double length_sigma = 0;            // of lengths, as a share; 0: not known
};

struct Options {
  ParsedOptions parsed;
  Settings settings;
};

// Parses and checks the command line. Error for an unknown option, a missing file and a value out
// of range.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
