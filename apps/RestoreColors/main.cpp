// SPDX-License-Identifier: GPL-3.0-or-later
// Gives photographs the colours that they have without water.

#include <algorithm>
#include <functional>

#include "base/atomic_file.h"
#include "base/context.h"
#include "base/error.h"
#include "base/naming.h"
#include "base/output_lock.h"
#include "belong/surface_check.h"
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

// The memory to fit both models, for each observation.
constexpr std::uint64_t kBytesToFit = 1000;

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

// The upward direction in the frame of the scene, unit; zero: not known.
Eigen::Vector3d up_of(const Settings& settings, const survey::Survey& survey) {
  if (settings.up) return settings.up->normalized();
  if (survey.frame.is_world()) return Eigen::Vector3d::Zero();
  return Eigen::Vector3d::UnitZ();
}

// Takes the type of water for channels that are not determined, and removes the loss of daylight by
// depth.
void use_daylight(const Settings& settings, const color::Observations& observations,
                  bool has_heights, Findings& findings, const Context& context) {
  auto* const water = std::get_if<color::SunWater>(&findings.choice.model);
  if (!water) {
    if (settings.assumed) context.warning("--assume: is only for daylight; it is not used");
    if (settings.up) context.info("--up: is only for daylight; it is not used");
    return;
  }
  findings.daylight = color::daylight_of(*water, settings.assumed);
  if (!findings.daylight) return;
  if (settings.assumed) color::assume(*findings.daylight, *water);
  if (has_heights)
    color::remove_daylight_loss(*findings.daylight, observations, *water);
  else
    context.info(
        "heights are not known: daylight's loss by depth is not removed. --up gives the direction "
        "of the heights");
}

// Fits the model, and with Settings::each_exposure the exposures, by which it divides the
// observations.
color::Exposures fit_exposures(const Settings& settings, std::size_t views,
                               color::Observations& observations, color::Choice& choice) {
  constexpr int kMost = 8;
  constexpr double kEnough = 0.002;
  color::Exposures exposures(views, Eigen::Array3f::Ones());
  Settings fixed = settings;
  color::Exposures step = color::even_exposures(observations, views);
  for (int i = 0; i < kMost; ++i) {
    observations = color::divided_by(step, std::move(observations));
    for (std::size_t view = 0; view < views; ++view) exposures[view] *= step[view];
    choice = fit(fixed, observations);
    fixed.light = choice.light;
    step = color::exposures_by(choice.model, observations, views);
    if (color::difference_of(step) < kEnough) break;
  }
  return exposures;
}

color::Observations observe(const Settings& settings, const survey::Survey& survey,
                            const color::SeenSurface& surface, const Context& context) {
  context.memory().require(
      color::SeenSurface::bytes_to_observe(settings.observe) + bytes_to_restore(settings, survey),
      "looking at photographs");
  const color::Observations observations = surface.observe(
      survey::posed_cameras(survey),
      [&](std::size_t view) {
        PhotographLight photograph = read_light(survey, view, settings.transfer);
        color::mark_unusable(photograph.light, photograph.mask, settings.transfer);
        return photograph.light;
      },
      settings.observe, context);
  if (observations.points() < 100)
    fail_in(settings.mesh,
            "only {} even pieces of the mesh are in two photographs or more: must be 100",
            observations.points());
  context.memory().require(observations.all.size() * kBytesToFit, "comparing colours");
  return observations;
}

Findings find(const Settings& settings, const survey::Survey& survey,
              const color::SeenSurface& surface, const Context& context) {
  color::Observations observations = observe(settings, survey, surface, context);
  Findings findings;
  const std::size_t views = survey.views.size();
  findings.raw_spread = color::spread_of(observations, nullptr);
  if (settings.each_exposure)
    findings.exposures = fit_exposures(settings, views, observations, findings.choice);
  else
    findings.choice = fit(settings, observations);
  findings.exposures_left =
      color::difference_of(color::exposures_by(findings.choice.model, observations, views));
  use_daylight(settings, observations, !up_of(settings, survey).isZero(), findings, context);
  findings.curve = settings.curve;
  findings.curve_given = settings.curve_given;
  findings.light_given = settings.light.has_value();
  findings.points = observations.points();
  findings.observations = observations.all.size();
  findings.spread = color::spread_of(observations, &findings.choice.model);
  if (std::ranges::none_of(color::determined(findings.choice.model), std::identity()))
    fail_in(
        settings.mesh,
        "the photographs determine the loss of no channel: they show the same points from equal "
        "distances, or too few points of the mesh, or hardly any light of the seabed");
  findings.gain = color::grey_world(observations, findings.choice.model);
  findings.unevenness = color::unevenness_by_place(observations, findings.choice.model);
  findings.brightness = color::brightness_by_way(observations, findings.choice.model);
  return findings;
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
      const color::Restored restored =
          restored_photograph(settings, survey, surface, findings, view);
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
