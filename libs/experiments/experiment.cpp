// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/experiment.h"

#include <fmt/format.h>

#include <set>

#include "base/error.h"

namespace axial::experiments {

std::vector<Experiment> all_experiments(bool quick) {
  return {figure2(quick), runtime(quick), figure3(quick), figure4(quick)};
}

std::string series_title(const std::string& series) {
  if (series == "fov_degrees") return "field of view [degrees]";
  if (series == "distance_mm") return "interface distance [mm]";
  if (series == "tilt_degrees") return "interface tilt [degrees]";
  if (series == "plane_degrees") return "plane angle [degrees]";
  if (series == "n_glass") return "refractive index of the glass";
  if (series == "n_water") return "refractive index of the water";
  fail("'{}' is not a parameter of the simulations", series);
}

std::string value_title(const std::string& series, double value) {
  if (series == "distance_mm") return fmt::format("distance {:g} mm", value);
  const std::string title = series_title(series);
  if (series.starts_with("n_")) return fmt::format("{} {:g}", title, value);
  return fmt::format("{} {:g}\u00b0", title.substr(0, title.find(" [")), value);
}

Json to_json(const CameraSetup& setup) {
  return {{"fov_degrees", setup.fov_degrees}, {"distance", setup.distance},
          {"thickness", setup.thickness},     {"tilt_degrees", setup.tilt_degrees},
          {"n_glass", setup.n_glass},         {"n_water", setup.n_water}};
}

Json to_json(const StereoSetup& setup) {
  return {{"setup", setup.number},
          {"camera", to_json(setup.camera)},
          {"plane_degrees", setup.plane_degrees}};
}

std::string part_name(const std::string& series, double value, int stereo_number) {
  const StereoSetup usual{stereo_number, {}, 0};
  const bool is_default = to_json(vary(series, value, stereo_number).setup) == to_json(usual);
  return is_default ? fmt::format("setup{}_default", stereo_number)
                    : fmt::format("setup{}_{}_{:g}", stereo_number, series, value);
}

std::vector<Variation> variations(const std::vector<Series>& series, int stereo_number) {
  std::vector<Variation> all;
  std::set<std::string> names;
  for (const Series& one : series)
    for (const double value : one.values)
      if (names.insert(part_name(one.name, value, stereo_number)).second)
        all.push_back(vary(one.name, value, stereo_number));
  return all;
}

const Json& result_of(const Json& results, const std::string& part) {
  return results.at("parts").at(part).at("result");
}

}  // namespace axial::experiments
