// SPDX-License-Identifier: GPL-3.0-or-later
// Carries labels from a map to the photographs that see them, and from photographs to the map.

#include <algorithm>
#include <optional>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/naming.h"
#include "base/output_lock.h"
#include "belong/surface_check.h"
#include "directions.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "map/label_file.h"
#include "scene/check_mesh.h"

namespace axial::apps {

std::vector<std::filesystem::path> outputs_of(const Settings& settings) {
  const auto named = [&](const char* end) {
    return std::filesystem::path(settings.output.string() + end);
  };
  if (settings.from_map.empty()) return {named(".geojson"), named(".gpkg")};
  return {named(".json")};
}

void warn_of(const std::vector<std::string>& names, const std::string& what) {
  constexpr std::size_t kMost = 5;
  for (std::size_t i = 0; i < std::min(kMost, names.size()); ++i)
    log_warning("label '{}': {}", names[i], what);
  if (names.size() > kMost) log_warning("{} more labels: {}", names.size() - kMost, what);
}

GivenLabels read_given(const Settings& settings, const std::string& crs) {
  constexpr std::size_t kMost = 65535;  // values of a mask of 16 bits
  GivenLabels given;
  if (settings.from_map.empty()) {
    given.in_photographs = labels::read_coco(settings.from_photographs);
    return given;
  }
  given.on_map = map::read_labels(settings.from_map, crs, settings.class_field);
  const std::size_t classes = labels::categories_of(given.on_map).size();
  if (!settings.masks.empty() && classes > kMost)
    fail_in(settings.from_map, "has {} classes, but --masks can show {} at most", classes, kMost);
  return given;
}

namespace {

Mesh read_mesh(const Settings& settings, const LocalFrame& frame, const Context& context) {
  context.memory().require(io::bytes_to_read_mesh(settings.mesh),
                           "reading " + settings.mesh.string());
  Mesh mesh = io::read_mesh_of_scene(frame, settings.mesh, context);
  mesh.colors = {};
  if (mesh.faces.empty()) fail_in(settings.mesh, "the mesh has no faces");
  naming(settings.mesh, [&] { check_mesh(mesh); });
  context.memory().require(labels::bytes_of_labelled_surface(mesh), "searching the mesh");
  return mesh;
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const Settings& settings = options.settings;
  const Context context = program_context(options.parsed);
  const std::vector<std::filesystem::path> outputs = outputs_of(settings);
  const OutputLock lock = lock_output(outputs.front());
  std::optional<OutputLock> masks_lock;
  if (!settings.masks.empty()) {
    masks_lock.emplace(settings.masks, LockUse::alone, ParentFolder::made);
    require_writable_folder(settings.masks);
  }
  survey::Survey survey = survey::open_scene(settings.survey, context);
  survey.add_inputs(io::files_of_mesh(settings.mesh));
  survey.add_inputs(std::vector{settings.from_map, settings.from_photographs, settings.place.map});
  survey.keep_inputs(outputs, "--output-file");
  const map::MapPlace place = map::place_of(settings.place);
  const GivenLabels given = read_given(settings, place.crs);
  const Mesh mesh = read_mesh(settings, survey.frame, context);
  belong::check_surface(survey.scene, belong::shape_of(mesh), {settings.mesh, survey.file()},
                        context);
  survey::find_photographs(survey, context);
  survey.keep_inputs(outputs, "--output-file");  // the photographs are inputs, too
  const labels::LabelledSurface surface(mesh, survey.frame, place.axes);
  const Ground ground{settings, given, survey, surface, place.crs};
  if (settings.from_map.empty())
    to_map(ground, context);
  else
    to_photographs(ground, context);
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("ProjectLabels", [&] { return axial::apps::run(argc, argv); });
}
