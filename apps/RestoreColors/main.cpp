// SPDX-License-Identifier: GPL-3.0-or-later
// Gives photographs the colours that they have without water.

#include <algorithm>
#include <span>

#include "base/atomic_file.h"
#include "base/context.h"
#include "base/error.h"
#include "base/naming.h"
#include "base/output_lock.h"
#include "belong/surface_check.h"
#include "find.h"
#include "geometry/seen_part.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "options.h"
#include "photographs.h"
#include "report.h"
#include "scene/check_mesh.h"
#include "unfinished.h"
#include "white.h"

namespace axial::apps {
namespace {

Mesh read_mesh(const Settings& settings, const LocalFrame& frame, const Context& context) {
  context.memory().require(io::bytes_to_read_mesh(settings.mesh),
                           "reading " + settings.mesh.string());
  Mesh mesh = io::read_mesh_of_scene(frame, settings.mesh, context);
  if (mesh.faces.empty()) fail_in(settings.mesh, "the mesh has no faces");
  naming(settings.mesh, [&] { check_mesh(mesh); });
  return mesh;
}

// Warns of a mesh that is inside out, and of a scene without a port.
void check_scene(const Settings& settings, const survey::Survey& survey, const Mesh& mesh,
                 const Context& context) {
  geometry::warn_if_inside_out(
      geometry::find_seen_part(mesh, survey::posed_cameras(survey), {.strays = false}),
      settings.mesh, context);
  if (std::ranges::none_of(survey.views,
                           [](const survey::View& view) { return view.camera.port.has_value(); }))
    context.warning("{}: no camera is behind a port; lengths are taken for metres",
                    survey.file().string());
}

// Restores the photographs that an earlier run has not restored. Returns the share of pixels whose
// colour is determined.
double restore_photographs(const Settings& settings, const survey::Survey& survey,
                           const color::SeenSurface& surface, const Findings& findings,
                           const Unfinished& unfinished, const Context& context) {
  ProgressCounter progress(context.stage("Restoring photographs"), survey.views.size());
  double known = 0, all = 0;
  std::size_t earlier = 0;
  for (std::size_t view = 0; view < survey.views.size(); ++view) {
    all += static_cast<double>(survey.views[view].pixels());
    if (const auto pixels = unfinished.known_pixels(view)) {
      known += static_cast<double>(*pixels);
      ++earlier;
    } else {
      const color::Restored restored = restored_photograph(survey, surface, findings, view);
      unfinished.write(view, restored, settings.jpeg_quality);
      known += cv::countNonZero(restored.known);
    }
    progress.add();
  }
  if (earlier > 0) log_info("{} photographs were restored by an earlier run", earlier);
  return known / all;
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const Settings& settings = options.settings;
  const Context context = program_context(options.parsed);
  require_writable_folder(settings.output);
  const OutputLock lock = lock_output(settings.output);
  survey::Survey survey = survey::open_scene(settings.survey, context);
  const Mesh mesh = read_mesh(settings, survey.frame, context);
  belong::check_surface(survey.scene, belong::shape_of(mesh), {settings.mesh, survey.file()},
                        context);
  survey::find_photographs(survey, context);
  survey.add_inputs(io::files_of_mesh(settings.mesh));
  if (!settings.exposures.empty()) survey.add_inputs(std::span(&settings.exposures, 1));
  const OutputNames names = output_names(settings, survey);
  check_outputs(settings, survey, names);
  const WhiteViews white = white_views(settings, survey);
  context.memory().require(color::bytes_to_see(mesh) + bytes_to_restore(settings, survey),
                           "restoring photographs");
  check_scene(settings, survey, mesh, context);
  const color::SeenSurface surface(mesh, up_of(settings, survey));
  Findings findings = find(settings, survey, surface, context);
  find_white(settings, survey, surface, white, findings, context);
  log_findings(findings, context);
  const Unfinished unfinished(settings.output, names,
                              made_from(settings, survey, mesh, findings, context));
  findings.known = restore_photographs(settings, survey, surface, findings, unfinished, context);
  write_folder(settings.output, [&](const std::filesystem::path& staging) {
    unfinished.give_to(staging);
    write_findings(staging, findings);
  });
  unfinished.remove();
  log_info("{} photographs without water in {}", survey.views.size(), settings.output.string());
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("RestoreColors", [&] { return axial::apps::run(argc, argv); });
}
