// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/program.h"
#include "simulate/presets.h"

namespace axial::apps {

struct Arguments {
  simulate::PresetOptions preset;
  std::string output, medium = "both", lens;
  int samples = 3, jpeg_quality = 93;
  double haze = 0, noise = 1.2;
  bool truth = true, truth_only = false;
  double water_level = 0;
  double dome_radius = 0, dome_x = 0, dome_y = 0, dome_z = 0;
  double port_distance = 0, port_thickness = 0, tilt_degrees = 0, n_glass = 1, n_water = 1;
};

// The options of SimulateUnderwater, bound to `a`.
ProgramOptions describe(Arguments& a);

// Error that names the option and its value.
void check(const Arguments& a);

// Gives the preset the lens of --lens. Error for an unknown model, a wrong number of coefficients,
// and a lens that does not fill its image.
void apply_lens_option(simulate::Preset& preset, const Arguments& a);

// Sets the given properties of the preset's port, or replaces the port by a water surface. Error
// for options that contradict each other.
void apply_port_options(simulate::Preset& preset, const Arguments& a, const ParsedOptions& parsed);

}  // namespace axial::apps
