// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/program/program.h"
#include "simulate/presets/presets.h"
#include "simulate/second_camera.h"

namespace axial::apps {

struct Arguments {
  simulate::PresetOptions preset;
  std::filesystem::path output;
  std::string medium = "both", lens;
  int samples = 3, jpeg_quality = 93;
  int sparse_points = 400;  // for each view
  double haze = 0, noise = 1.2;
  double exposure_stops = 0;
  std::string water, light = "sun", response = "srgb";  // water: empty for light without water
  double depth = 6;                                     // of the world's z = 0 [m]
  double scattering = -1;                               // [1/m]; below 0: usual for the water
  bool truth = true, truth_only = false;
  int targets = 0;  // single plates
  std::string target_family = "circular12";
  double target_side = 0.1;  // [m]
  std::vector<double> bars;  // lengths [m]
  double water_level = 0;
  double dome_radius = 0, dome_x = 0, dome_y = 0, dome_z = 0;
  simulate::SecondCamera second_camera;
  double port_distance = 0, port_thickness = 0, tilt_degrees = 0, n_glass = 1, n_water = 1;
};

// Returns the options of SimulateUnderwater. Parsing the options fills `a`.
ProgramOptions describe(Arguments& a);

// Error if options are missing or contradict each other.
void check(const Arguments& a, const ParsedOptions& parsed);

// Replaces the preset's lens by the lens of --lens, if this option is given. Error for an unknown
// model, for a wrong number of coefficients, and for a lens that has no ray at a pixel of the
// image's border.
void apply_lens_option(simulate::Preset& preset, const Arguments& a);

// Sets the properties of the preset's port for which options are given, or replaces the port by a
// water surface. Error for options that contradict each other.
void apply_port_options(simulate::Preset& preset, const Arguments& a, const ParsedOptions& parsed);

}  // namespace axial::apps
