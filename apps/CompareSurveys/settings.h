// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "axial/compare.h"
#include "base/program/program.h"
#include "boundary/options.h"

namespace axial::apps {

enum class Align { none, ground, targets, automatic };

struct Settings {
  std::filesystem::path before, after;              // the meshes
  std::filesystem::path scene_before, scene_after;  // empty: not given
  // The places of the targets; empty: those in the folders of the meshes.
  std::filesystem::path targets_before, targets_after;
  Align align = Align::none;
  std::filesystem::path working_folder;
  std::filesystem::path output;       // the names of the files without ".change.json" and so on
  std::optional<Eigen::Vector3d> up;  // in the world; empty: see place_map() in main.cpp
  boundary::Options boundary;         // in the coordinates of the earlier survey
  int epsg = 0;                       // 0: no coordinate reference system
  compare::CompareOptions compare;
};

struct Options {
  ParsedOptions parsed;
  Settings settings;
};

// Parses and checks the command line. Error for an unknown option, a missing survey and a value out
// of range.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
