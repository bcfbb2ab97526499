// SPDX-License-Identifier: GPL-3.0-or-later
#include "axial/densify.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "src/bind.h"
#include "src/densify_options.h"
#include "src/records.h"
#include "src/stage.h"
#include "src/survey_call.h"

namespace axial::python {
namespace {

namespace fs = std::filesystem;
using py::literals::operator""_a;

// Passes the depth maps to Python.
std::function<void(std::size_t, DepthMap)> map_sink(const py::object& take_map) {
  if (take_map.is_none()) return {};
  return [&take_map](std::size_t image, DepthMap map) {
    const py::gil_scoped_acquire locked;
    take_map(image, fields_of(std::move(map)));
  };
}

py::dict report_fields(const densify::Report& report) {
  const py::object cloud = report.cloud.empty() ? py::object(py::none()) : py::cast(report.cloud);
  return py::dict("cloud_file"_a = cloud, "points"_a = report.points,
                  "depth_maps"_a = report.depth_maps, "only_pinholes"_a = report.only_pinholes);
}

py::dict densify_files(const SurveyCall& call, densify::Options& options,
                       const StageControls& controls) {
  take_files(call, options.survey);
  if (options.output.scene.empty())
    options.output.scene = fs::path(options.survey.files.scene).replace_extension() += "_dense.mvs";
  densify::Report report;
  run_stage(controls,
            [&](const Context& context) { report = densify::densify(options, {}, context); });
  return report_fields(report);
}

py::dict densify_memory(const SurveyCall& call, const densify::Options& options,
                        const StageControls& controls) {
  survey::MemorySurvey survey = memory_survey(call);
  densify::MemoryResult result;
  run_stage(controls, [&](const Context& context) {
    result = densify::densify(std::move(survey), options, context);
  });
  py::dict fields = report_fields(result.report);
  fields["cloud"] = fields_of(std::move(result.cloud), result.frame);
  return fields;
}

py::dict run(const py::object& scene, const py::object& photographs, const py::object& masks,
             const py::object& take_map, const py::dict& keywords) {
  const SurveyCall call{scene, photographs, masks};
  densify::Options options;
  StageControls controls;
  Keywords known;
  add_keywords(known, options);
  controls.add_to(known);
  known.add("output", options.output.scene)
      .add("working_folder", options.survey.files.working_folder);
  known.take(keywords, "densify");
  use_given_masks(keywords, options.survey);
  if (call.in_memory()) refuse_in_memory(keywords, {"errors"});
  // As for DensifyPointCloud: who states a number wants it for all points.
  if (keywords.contains("min_views") && !keywords.contains("two_if_undisputed"))
    options.fusion.two_if_undisputed = false;
  if (!options.output.scene.empty()) options.output.scene.replace_extension(".mvs");
  options.output.take_map = map_sink(take_map);
  return call.in_memory() ? densify_memory(call, options, controls)
                          : densify_files(call, options, controls);
}

}  // namespace

void bind_densify(py::module_& module) {
  module.def("densify", &run);
}

}  // namespace axial::python
