// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/experiment.h"

#include <fmt/format.h>

#include <set>

namespace axial::experiments {

std::vector<Experiment> all_experiments(bool quick) {
  return {figure2(quick), runtime(quick), figure3(quick), figure4(quick)};
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

}  // namespace axial::experiments
