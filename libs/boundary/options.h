// SPDX-License-Identifier: GPL-3.0-or-later
// The options by which several programs get the boundary of a survey.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/program/option_list.h"
#include "base/program/program.h"

namespace axial::boundary {

struct Options {
  std::filesystem::path file;        // polygons (map/areas.h); empty: none
  std::vector<std::string> targets;  // labels of the corners, in order; in place of `file`
  std::filesystem::path places;      // of the targets; empty: those beside the mesh
  // The map, or the comparison, whose axes and reference system the polygons have; empty: none.
  std::filesystem::path map;

  bool is_given() const { return !file.empty() || !targets.empty(); }
  // The files that are named.
  std::vector<std::filesystem::path> inputs() const { return {file, places, map}; }
};

// Adds the options `--boundary`, `--boundary-targets`, `--target-places` and `--boundary-map` to
// `list`. `options` must exist until parse_options() has returned. The program then calls check().
void declare(OptionList& list, Options& options);

// For programs that make a map: adds `--like` besides, another name of `--boundary-map`, which here
// needs no boundary. The program then calls check_like(), too.
void declare_like(OptionList& list, Options& options);

// Error for options that contradict each other or that need another one.
void check(const ParsedOptions& parsed, const Options& options);

// Error if `--up` or `--epsg` contradict Options::map.
void check_like(const ParsedOptions& parsed);

}  // namespace axial::boundary
