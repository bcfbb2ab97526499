// SPDX-License-Identifier: GPL-3.0-or-later
// DensifyPointCloud's options: the options of OpenMVS with the same names, and the options for
// refraction. Three defaults differ from OpenMVS: --iters (2; OpenMVS: 3), --postprocess-dmaps (3;
// OpenMVS: 7) and --tower-mode (0; OpenMVS: 4).
#pragma once

#include "axial/densify.h"
#include "base/program/program.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  densify::Options settings;
};

// Parses and checks the command line. Error for an unknown option, for a value out of range, and
// for an OpenMVS option that is not implemented, unless it has its default or "off" value.
// `parsed.run` is false if nothing is left to do.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
