// SPDX-License-Identifier: GPL-3.0-or-later
// What all experiments look like to the program: independent parts, each computed once and kept,
// and documents (figures and tables) made from the kept numbers alone.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/setup.h"

namespace axial::experiments {

using Json = nlohmann::ordered_json;

struct Part {
  std::string name;               // unique within the experiment, fit for a file name
  Json inputs;                    // everything the result depends on but the machine
  std::function<Json()> compute;  // the same bytes for any number of threads, times excepted
};

struct Document {
  std::string file;  // "figure2.svg", "figure2.md"
  std::string text;
};

struct Experiment {
  std::string name;
  std::vector<Part> parts;
  // From {"experiment", "quick", "parts": {name: {"inputs", "result"}, ...}}.
  std::function<std::vector<Document>(const Json& results)> documents;
};

// Quick: the same parts from fewer samples, for tests.
Experiment figure2(bool quick);
Experiment runtime(bool quick);
Experiment figure3(bool quick);
Experiment figure4(bool quick);

// All that need no other program.
std::vector<Experiment> all_experiments(bool quick);

// One parameter and its values, the default's among them.
struct Series {
  std::string name;  // as `vary` knows it
  std::vector<double> values;
};

std::string series_title(const std::string& series);               // "interface distance [mm]"
std::string value_title(const std::string& series, double value);  // "distance 20 mm"

// Name of the part of one value, "setup1_fov_degrees_100": the default, which is in every series,
// is one part, "setup1_default".
std::string part_name(const std::string& series, double value, int stereo_number);

// Every value of every series once.
std::vector<Variation> variations(const std::vector<Series>& series, int stereo_number);

Json to_json(const CameraSetup& setup);
Json to_json(const StereoSetup& setup);

// `results["parts"][part]["result"]`.
const Json& result_of(const Json& results, const std::string& part);

}  // namespace axial::experiments
