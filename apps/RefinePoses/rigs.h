// SPDX-License-Identifier: GPL-3.0-or-later
// The rigs of RefinePoses: their options, their files, and what is reported about them.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/program/option_list.h"
#include "io/colmap/colmap.h"
#include "pose/adjust/uncertainty.h"
#include "pose/bundle/adjust_options.h"
#include "pose/rig_frames.h"

namespace axial::apps {

// The values of the options --rig and --rig-*.
struct RigInput {
  std::filesystem::path file;  // rig_config.json, rigs.txt or rigs.bin; empty: no rig
  std::string poses = "stated";
  std::string frames;           // regular expression
  std::filesystem::path times;  // file of times
  double interval = 0;          // [s]; 0: not given
};

void declare_rigs(OptionList& visible, RigInput& rigs);

// Error if options of rigs are given without --rig, or if options contradict each other.
void check_rigs(const RigInput& rigs);

// The files that `rigs` names.
std::vector<std::filesystem::path> files_of(const RigInput& rigs);

// Reads the rigs for the images of `model`; none if no file is given. Error as for io::read_rigs(),
// io::read_photograph_numbers() and pose::make_rigs().
std::vector<pose::Rig> read_rigs(const RigInput& rigs, const io::ColmapModel& model);

// Multiplies stated poses and their standard deviations by the length on a map of one metre.
void scale_stated(std::vector<pose::Rig>& rigs, double map_scale);

// Returns a line for each rig: its cameras, and how many of its frames have several photographs.
std::vector<std::string> input_lines(const std::vector<pose::Rig>& rigs);

// Returns lines about each camera of a rig but the reference camera: its base and its standard
// deviation, the change against the stated pose, and how far its photographs deviate.
std::vector<std::string> rig_lines(const pose::Bundle& bundle, const pose::Uncertainty& known);

// Returns a warning for each camera that takes its photographs at another time than the reference
// camera, for photographs that deviate from their rig, and for each camera whose refined pose is
// more than three of its standard deviations from the stated one.
std::vector<std::string> rig_warnings(const pose::Bundle& bundle, const pose::Uncertainty& known);

// Returns the list "rigs" of the report; null if there is no rig. Standard deviations that are not
// known are null. `known.rig_sigmas` may be empty.
nlohmann::ordered_json rigs_json(const pose::Bundle& bundle, const pose::Uncertainty& known);

}  // namespace axial::apps
