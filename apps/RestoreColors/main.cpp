// SPDX-License-Identifier: GPL-3.0-or-later
// Gives photographs the colours that they have without water.

#include "base/atomic_file.h"
#include "base/context.h"
#include "base/error.h"
#include "base/naming.h"
#include "base/same_file.h"
#include "belong/surface_check.h"
#include "io/openmvs/point_source.h"
#include "options.h"
#include "photographs.h"
#include "report.h"
#include "scene/check_mesh.h"

namespace axial::apps {
namespace {

Mesh read_mesh(const Settings& settings, const LocalFrame& frame, const Context& context) {
  context.memory().require(io::bytes_to_read_mesh(settings.mesh),
                           "reading " + settings.mesh.string());
  Mesh mesh = io::read_mesh_of_scene(frame, settings.mesh);
  if (mesh.faces.empty()) fail_in(settings.mesh, "the mesh has no faces");
  naming(settings.mesh, [&] { check_mesh(mesh); });
  return mesh;
}

color::Choice fit(const Settings& settings, const color::Observations& observations) {
  if (!settings.light) return color::choose_light(observations, settings.transfer);
  color::Choice choice;
  choice.light = *settings.light;
  if (choice.light == color::Light::sun)
    choice.model = color::fit_sun(observations, settings.transfer);
  else
    choice.model = color::fit_lamps(observations, settings.transfer);
  return choice;
}

Findings find(const Settings& settings, const survey::Survey& survey,
              const color::SeenSurface& surface, const Context& context) {
  const color::Observations observations = surface.observe(
      survey::posed_cameras(survey),
      [&](std::size_t view) { return read_light(survey, view, settings.transfer); },
      settings.observe, context);
  if (observations.points() < 100)
    fail_in(settings.mesh, "only {} points of the mesh are in two photographs or more: must be 100",
            observations.points());
  Findings findings;
  findings.choice = fit(settings, observations);
  findings.light_given = settings.light.has_value();
  findings.points = observations.points();
  findings.observations = observations.all.size();
  findings.raw_spread = color::spread_of(observations, nullptr);
  findings.spread = color::spread_of(observations, &findings.choice.model);
  findings.gain = color::grey_world(observations, findings.choice.model);
  return findings;
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const Settings& settings = options.settings;
  const Context context = program_context(options.parsed);
  require_writable_folder(settings.output);
  survey::Survey survey = survey::open_scene(settings.survey, context);
  const Mesh mesh = read_mesh(settings, survey.frame, context);
  belong::check_surface(survey.scene, belong::shape_of(mesh), {settings.mesh, survey.file()},
                        context);
  survey::find_photographs(survey, context);
  for (const std::filesystem::path& name : output_names(survey))
    require_not_an_input(settings.output / name, survey.inputs, "--output");
  if (settings.grey) view_of_grey(*settings.grey, survey);
  context.memory().require(color::bytes_to_see(mesh) + bytes_to_restore(survey), "the photographs");
  const color::SeenSurface surface(mesh);
  Findings findings = find(settings, survey, surface, context);
  if (settings.grey) {
    findings.gain = grey_gain(settings, survey, surface, findings.choice.model, findings.gain);
    findings.grey_given = true;
  }
  log_findings(findings, context);
  write_folder(settings.output, [&](const std::filesystem::path& staging) {
    findings.known = write_restored(settings, survey, surface, findings.choice.model, findings.gain,
                                    staging, context);
    write_findings(staging, findings);
  });
  log_info("{} photographs without water in {}", survey.views.size(), settings.output.string());
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("RestoreColors", [&] { return axial::apps::run(argc, argv); });
}
