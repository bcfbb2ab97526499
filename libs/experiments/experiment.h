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

// A part of an experiment.
struct Part {
  std::string name;  // unique within the experiment, valid as part of a file name
  Json inputs;       // everything on which the result depends, except the machine
  // Returns the result. Except for measured times, the result is the same for any number of
  // threads.
  std::function<Json()> compute;
};

// A figure or table.
struct Document {
  std::string file;  // name of the file: "figure2.svg", "figure2.md"
  std::string text;  // content of the file
};

struct Experiment {
  std::string name;  // valid as part of a file name
  std::vector<Part> parts;
  // Makes the documents from the results of all parts. `results` is an object with the fields
  // "experiment" (the name), "quick" (true or false) and "parts". The field "parts" is an object
  // with a field for each part, by its name. The value of this field is an object with the fields
  // "inputs" (Part::inputs) and "result" (the return value of Part::compute).
  std::function<std::vector<Document>(const Json& results)> documents;
};

// The experiments of the paper's figures and run times. `quick`: the same parts with fewer samples,
// for tests.
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

// In the next three functions, `series` is a name that vary() accepts, `value` is in the unit in
// this name, and `stereo_number` is StereoSetup::number. The functions throw an Error for another
// name.

// Returns a title for the axis of a chart: "interface distance [mm]".
std::string series_title(const std::string& series);
// Returns a title for one value: "distance 20 mm".
std::string value_title(const std::string& series, double value);

// Returns the name of the part for one value of a series: "setup1_fov_degrees_100". The default
// setup occurs in every series and has one name for all series: "setup1_default".
std::string part_name(const std::string& series, double value, int stereo_number);

// Returns one variation for each value of each series, in the order of the series and values. The
// default setup is contained only once, where it occurs first. `stereo_number`:
// StereoSetup::number. Error if vary() does not accept the name of a series.
std::vector<Variation> variations(const std::vector<Series>& series, int stereo_number);

// Return all fields of the setup, as inputs of a part (Part::inputs).
Json to_json(const CameraSetup& setup);
Json to_json(const StereoSetup& setup);

// Returns results["parts"][part]["result"]. `results` has the form that Experiment::documents
// takes. Precondition: `results` contains the part.
const Json& result_of(const Json& results, const std::string& part);

}  // namespace axial::experiments
