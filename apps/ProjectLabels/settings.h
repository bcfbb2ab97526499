// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "axial/survey.h"
#include "base/program/program.h"
#include "labels/joined_labels.h"
#include "map/map_place.h"

namespace axial::apps {

struct Settings {
  survey::Options survey;
  std::filesystem::path mesh;
  // The files of labels. Exactly one of the two paths is empty.
  std::filesystem::path from_map, from_photographs;
  map::PlaceOptions place;
  std::filesystem::path output;  // the names of the files without their extensions
  std::string class_field;       // of from_map; empty: the usual ones
  std::filesystem::path masks;   // folder for pictures of from_map's labels; empty: none
  double least_part = 0.02;      // of a label of from_photographs: share of its pixels
  labels::JoinOptions join;      // of labels of from_photographs
};

struct Options {
  ParsedOptions parsed;
  Settings settings;
};

// Parses and checks the command line. Error for an unknown option, a missing file, a value out of
// range, and options that contradict each other.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
