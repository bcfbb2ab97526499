// SPDX-License-Identifier: GPL-3.0-or-later
// The common form of all experiments: independent parts, each computed once and stored, and
// documents (figures and tables) made from the stored numbers alone.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/setup.h"

namespace axial::experiments {

using Json = nlohmann::ordered_json;

struct Part {
  std::string name;               // unique within the experiment, valid as part of a file name
  Json inputs;                    // everything on which the result depends, except the machine
  std::function<Json()> compute;  // except for times, the same bytes for any number of threads
};

struct Document {
  std::string file;  // "figure2.svg", "figure2.md"
  std::string text;
};

struct Experiment {
  std::string name;
  std::vector<Part> parts;
  // Makes the documents from the results of all parts. `results` has the form {"experiment",
  // "quick", "parts": {name: {"inputs", "result"}, ...}}.
  std::function<std::vector<Document>(const Json& results)> documents;
};

// The experiments of the paper's figures and run times. `quick`: the same parts with fewer samples,
// for tests.
Experiment figure2(bool quick);
Experiment runtime(bool quick);
Experiment figure3(bool quick);
Experiment figure4(bool quick);

// All experiments that need no other program.
std::vector<Experiment> all_experiments(bool quick);

// A parameter and its values, which include the default value.
struct Series {
  std::string name;  // a name that vary() accepts
  std::vector<double> values;
};

std::string series_title(const std::string& series);               // "interface distance [mm]"
std::string value_title(const std::string& series, double value);  // "distance 20 mm"

// Returns the name of the part for one value of a series: "setup1_fov_degrees_100". The default
// setup occurs in every series and has one name for all series: "setup1_default".
std::string part_name(const std::string& series, double value, int stereo_number);

// Returns one variation for each value of each series. The default setup is contained only once.
std::vector<Variation> variations(const std::vector<Series>& series, int stereo_number);

Json to_json(const CameraSetup& setup);
Json to_json(const StereoSetup& setup);

// Returns `results["parts"][part]["result"]`. Precondition: `results` contain the part.
const Json& result_of(const Json& results, const std::string& part);

}  // namespace axial::experiments
