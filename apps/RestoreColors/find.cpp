// SPDX-License-Identifier: GPL-3.0-or-later
#include "find.h"

#include <algorithm>
#include <functional>

#include "base/context.h"
#include "base/error.h"
#include "given_exposures.h"
#include "photographs.h"

namespace axial::apps {
namespace {

// The memory to fit both models, for each observation.
constexpr std::uint64_t kBytesToFit = 1000;

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

color::Observations observe(const Settings& settings, const survey::Survey& survey,
                            const color::SeenSurface& surface, const color::Transfer& transfer,
                            const Context& context) {
  context.memory().require(
      color::SeenSurface::bytes_to_observe(settings.observe) + bytes_to_restore(settings, survey),
      "looking at photographs");
  const color::Observations observations = surface.observe(
      survey::posed_cameras(survey),
      [&](std::size_t view) {
        PhotographLight photograph = read_light(survey, view, transfer);
        color::mark_unusable(photograph.light, photograph.mask, transfer);
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

// Finds the curve of the camera by the given exposures, and observes again if it is another one.
void find_curve(const Settings& settings, const survey::Survey& survey,
                const color::SeenSurface& surface, Findings& findings,
                color::Observations& observations, const Context& context) {
  findings.found_curve =
      color::find_curve(findings.exposures, observations, findings.transfer, settings.light);
  if (findings.found_curve->transfer.name() == findings.transfer.name()) return;
  findings.transfer = findings.found_curve->transfer;
  observations = observe(settings, survey, surface, findings.transfer, context);
}

// Takes the exposures of Settings::exposures, and the curve that they tell. If the light of the
// points agrees better without these exposures, they are not used, with a warning: the light of a
// flash does not depend on the exposure time, for example.
void take_exposures(const Settings& settings, const survey::Survey& survey,
                    const color::SeenSurface& surface, Findings& findings,
                    color::Observations& observations, const Context& context) {
  const color::Exposures one = findings.exposures;
  const color::Transfer first = findings.transfer;
  const double without = color::spread_with(one, observations, first, settings.light);
  findings.exposures = given_exposures(settings.exposures, survey);
  if (!settings.curve) find_curve(settings, survey, surface, findings, observations, context);
  const double with =
      color::spread_with(findings.exposures, observations, findings.transfer, settings.light);
  if (with <= without) return;
  context.warning(
      "{}: the light of the photographs agrees better without these exposures: they are not used",
      settings.exposures.string());
  findings.exposure = ExposureKind::one;
  findings.exposures = one;
  findings.found_curve.reset();
  if (findings.transfer.name() == first.name()) return;
  findings.transfer = first;
  observations = observe(settings, survey, surface, first, context);
}

// Fits the model, and divides the observations by the exposures that are given or, with
// ExposureKind::each, estimated.
void fit(const Settings& settings, Findings& findings, color::Observations& observations) {
  if (findings.exposure == ExposureKind::each) {
    color::Evened evened = color::fit_exposures(observations, findings.exposures.size(),
                                                findings.transfer, settings.light);
    findings.choice = std::move(evened.choice);
    findings.exposures = std::move(evened.exposures);
    observations = std::move(evened.even);
    return;
  }
  if (findings.exposure == ExposureKind::given)
    observations = color::divided_by(findings.exposures, std::move(observations));
  findings.choice = color::fit_light(observations, findings.transfer, settings.light);
}

}  // namespace

Eigen::Vector3d up_of(const Settings& settings, const survey::Survey& survey) {
  if (settings.up) return settings.up->normalized();
  if (survey.frame.is_world()) return Eigen::Vector3d::Zero();
  return Eigen::Vector3d::UnitZ();
}

Findings find(const Settings& settings, const survey::Survey& survey,
              const color::SeenSurface& surface, const Context& context) {
  const std::size_t views = survey.views.size();
  Findings findings;
  findings.transfer = settings.curve.value_or(color::Transfer());
  findings.curve_given = settings.curve.has_value();
  findings.exposure = settings.exposure;
  findings.light_given = settings.light.has_value();
  findings.exposures.assign(views, Eigen::Array3f::Ones());
  color::Observations observations = observe(settings, survey, surface, findings.transfer, context);
  if (findings.exposure == ExposureKind::given)
    take_exposures(settings, survey, surface, findings, observations, context);
  findings.raw_spread = color::spread_of(observations, nullptr);
  fit(settings, findings, observations);
  findings.exposures_left =
      color::difference_of(color::exposures_by(findings.choice.model, observations, views));
  use_daylight(settings, observations, !up_of(settings, survey).isZero(), findings, context);
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

}  // namespace axial::apps
