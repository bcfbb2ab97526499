// SPDX-License-Identifier: GPL-3.0-or-later
// The common form of all experiments: independent parts, each computed once and stored.
// docs/paper/documents.py makes tables and figures from the stored numbers.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/setup.h"

namespace axial::experiments {

using Json = nlohmann::ordered_json;

// A part of an experiment.
struct Part {
  std::string name;  // unique within the experiment, valid as part of a file name
  Json inputs;       // everything on which the result depends, except the machine
  // Returns the result. Except for measured times, the result is the same for any number of
  // threads.
  std::function<Json()> compute;
};

struct Experiment {
  std::string name;  // valid as part of a file name
  std::vector<Part> parts;
};

// The experiments of the paper's figures and run times. `quick`: the same parts with fewer samples,
// for tests. The quick figure 4 has images of real size for five setups only.
Experiment figure2(bool quick);  // errors of round trips through the port (projection_error.h)
Experiment runtime(bool quick);  // times of projections (projection_time.h)
Experiment figure3(bool quick);  // errors of every texel of every patch (patch_error.h)
Experiment figure4(bool quick);  // mean errors of patches (patch_error.h)

// Returns the four experiments above. They need no other program.
std::vector<Experiment> all_experiments(bool quick);

// A parameter and its values, which include the default value.
struct Series {
  std::string name;  // a name that vary() accepts
  std::vector<double> values;
};

// Returns the name of the part for one value of a series: "setup1_fov_degrees_100". The default
// setup occurs in every series and has one name for all series: "setup1_default". `series` and
// `value`: as for vary(). `stereo_number`: StereoSetup::number. Error if vary() does not accept the
// name.
std::string part_name(const std::string& series, double value, int stereo_number);

// Returns one variation for each value of each series, in the order of the series and values. The
// default setup is contained only once, where it occurs first. `stereo_number`:
// StereoSetup::number. Error if vary() does not accept the name of a series.
std::vector<Variation> variations(const std::vector<Series>& series, int stereo_number);

// Return all fields of the setup, as inputs of a part (Part::inputs).
Json to_json(const CameraSetup& setup);
Json to_json(const StereoSetup& setup);

}  // namespace axial::experiments
