// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "base/context.h"
#include "io/bytes/json.h"

namespace axial::apps {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 3> kNames{"red", "green", "blue"};

json describe(const color::Estimate& estimate) {
  return {{"value", estimate.value}, {"sigma", estimate.sigma}};
}

json describe(const color::SunChannel& channel) {
  const Eigen::Vector3d& q = channel.veil_by_direction;
  json described = {{"a_per_m", describe(channel.a)},
                    {"b_per_m", describe(channel.b)},
                    {"veil", describe(channel.veil)},
                    {"veil_by_direction", {q[0], q[1], q[2]}},
                    {"direct", channel.direct},
                    {"determined", channel.determined},
                    {"residual_in_sigmas", channel.residual}};
  if (channel.assumed) described["assumed"] = true;
  if (channel.daylight.value > 0) described["daylight_per_m"] = describe(channel.daylight);
  return described;
}

// NaN becomes null.
json list(const Eigen::Array3f& color) {
  return {color[0], color[1], color[2]};
}

json describe(const color::BrightnessAt& layer) {
  return {{"way_m", layer.way}, {"before", list(layer.before)}, {"after", list(layer.after)}};
}

json describe(const color::LampChannel& channel) {
  return {{"loss_per_m", channel.loss},
          {"direct", channel.direct},
          {"determined", channel.determined},
          {"residual_in_sigmas", channel.residual}};
}

json describe(const SeenChart& chart) {
  json patches = json::array();
  for (const Eigen::Array3f& light : chart.lights) patches.push_back(list(light));
  return {{"photograph", chart.photograph},
          {"ciede2000", chart.error},
          {"gain", list(chart.gain)},
          {"patches", patches}};
}

const char* name_of(White white) {
  switch (white) {
    case White::grey_seabed:
      return "grey seabed";
    case White::grey_part:
      return "grey patch";
    case White::charts:
      return "charts";
  }
  return "";
}

const char* name_of(ExposureKind exposure) {
  switch (exposure) {
    case ExposureKind::one:
      return "one";
    case ExposureKind::given:
      return "given";
    case ExposureKind::each:
      return "each";
  }
  return "";
}

// Whether the exposures tell the curve of the camera.
bool is_told(const Findings& findings) {
  return findings.found_curve && findings.found_curve->is_told;
}

const char* curve_from(const Findings& findings) {
  if (findings.curve_given) return "option";
  return is_told(findings) ? "exposures" : "assumption";
}

const char* name_of(color::Light light) {
  return light == color::Light::sun ? "sun" : "lamp";
}

void log_channels(const color::SunWater& water) {
  for (std::size_t k = 0; k < 3; ++k) {
    const color::SunChannel& channel = water.channels[k];
    log_info("{}: loss a {:.3f} +- {:.3f} /m{}, veil B {:.3f} +- {:.3f}, b {:.3f} +- {:.3f} /m",
             kNames[k], channel.a.value, channel.a.sigma, channel.assumed ? " (assumed)" : "",
             channel.veil.value, channel.veil.sigma, channel.b.value, channel.b.sigma);
  }
}

void log_channels(const color::LampField& field) {
  for (std::size_t k = 0; k < 3; ++k)
    log_info("{}: loss {:.3f} /m, one way", kNames[k], field.channels[k].loss);
}

void log_daylight(const color::Daylight& daylight) {
  const auto& losses = daylight.losses;
  log_info(
      "Water like {}: by depth, daylight loses {:.3f} +- {:.3f}, {:.3f} +- {:.3f} and "
      "{:.3f} +- {:.3f} /m (R G B)",
      color::name_of(daylight.type), losses[0].value, losses[0].sigma, losses[1].value,
      losses[1].sigma, losses[2].value, losses[2].sigma);
}

bool falls_with_way(const color::LampField& field) {
  return std::ranges::any_of(field.channels, [](const color::LampChannel& channel) {
    return channel.determined && channel.loss > color::kLeastLoss;
  });
}

// Warns if the same points have different colours in the restored photographs.
void check_agreement(const Findings& findings, const Context& context) {
  constexpr double kMostUneven = 0.04, kMostSpread = 0.4, kMostExposure = 0.05;
  if (findings.exposure != ExposureKind::each && findings.exposures_left > kMostExposure)
    context.warning(
        "the photographs differ in exposure by {:.0f} %, but are restored with {}: try "
        "--exposure each",
        100 * findings.exposures_left,
        findings.exposure == ExposureKind::one ? "one exposure" : "the exposures of --exposures");
  if (findings.unevenness > kMostUneven)
    context.warning(
        "the restored light depends on the place in the image by {:.0f} %: {}",
        100 * findings.unevenness,
        findings.choice.light == color::Light::sun
            ? "is it the light of lamps (--light lamp), or do the photographs differ in exposure?"
            : "do the photographs differ in exposure, or do lamps move against the camera?");
  if (const auto* field = std::get_if<color::LampField>(&findings.choice.model);
      field && !falls_with_way(*field))
    context.warning(
        "light does not fall with the distance as that of lamps does: the water scatters most of "
        "it, or it is daylight (--light sun). The restored colours are uncertain");
  if (findings.spread > kMostSpread)
    context.warning(
        "the restored light of a point differs between photographs by {:.0f} % of the differences "
        "between points: are the port, the poses and the mesh right, and have the photographs one "
        "exposure?",
        100 * findings.spread);
}

// Warns of charts that do not agree.
void log_charts(const Findings& findings, const Context& context) {
  constexpr float kMostDifferent = 0.15f;
  for (const SeenChart& chart : findings.charts) {
    log_info(
        "Colour chart in {}: its patches differ from the published colours by CIEDE2000 {:.1f}",
        chart.photograph, chart.error);
    const float different = (chart.gain / findings.gain - 1).abs().maxCoeff();
    if (different > kMostDifferent)
      context.warning(
          "the chart in {} gives a white that differs by {:.0f} % from that of all charts: is a "
          "shadow on it, or are the exposures different?",
          chart.photograph, 100 * different);
  }
}

void log_curve(const Findings& findings, const Context& context) {
  if (findings.curve_given) return;
  if (is_told(findings))
    log_info(
        "The curve of the camera is {}, by the exposures: with it, the light of a point differs "
        "between photographs by {:.1f} %; with that of sRGB, by {:.1f} %",
        findings.transfer.name(), 100 * findings.found_curve->spread,
        100 * findings.found_curve->spread_first);
  else
    context.info(
        "The curve of the camera is not known: values are taken for light by the curve of sRGB. "
        "Photographs that were developed from raw files with gamma 1 need --curve linear{}",
        findings.found_curve ? ". The exposures do not tell the curve" : "");
}

}  // namespace

void log_findings(const Findings& findings, const Context& context) {
  log_info("Light: {}{}", name_of(findings.choice.light),
           findings.light_given ? " (given)" : ", by the photographs");
  if (findings.exposure != ExposureKind::one)
    log_info("Exposures differ by {:.1f} % between photographs",
             100 * color::difference_of(findings.exposures));
  std::visit([](const auto& water) { log_channels(water); }, findings.choice.model);
  if (findings.daylight) log_daylight(*findings.daylight);
  log_info("The light of a point differs between photographs by {:.1f} %; before, by {:.1f} %",
           100 * findings.spread, 100 * findings.raw_spread);
  check_agreement(findings, context);
  const std::array<bool, 3> known = color::determined(findings.choice.model);
  for (std::size_t k = 0; k < 3; ++k)
    if (!known[k])
      context.warning(
          "the loss of {} light is not determined by the photographs: {} stays as it is", kNames[k],
          kNames[k]);
  log_charts(findings, context);
  log_curve(findings, context);
  if (findings.white == White::grey_seabed)
    context.info(
        "White is an assumption: the seabed is taken for grey in the mean. --grey names "
        "something grey, --chart a colour chart");
}

namespace {

json describe(const Findings& findings) {
  json file = {{"light", name_of(findings.choice.light)},
               {"light_given", findings.light_given},
               {"curve", findings.transfer.name()},
               {"curve_from", curve_from(findings)},
               {"points", findings.points},
               {"observations", findings.observations},
               {"spread_before", findings.raw_spread},
               {"spread_after", findings.spread},
               {"unevenness_by_place", findings.unevenness},
               {"determined_pixels", findings.known},
               {"exposure", name_of(findings.exposure)},
               {"white", name_of(findings.white)},
               {"gain", list(findings.gain)}};
  if (!findings.light_given)
    file["spread_of_models"] = {{"sun", findings.choice.sun_spread},
                                {"lamp", findings.choice.lamp_spread}};
  for (const SeenChart& chart : findings.charts) file["charts"].push_back(describe(chart));
  if (is_told(findings))
    file["spread_of_curves"] = {{findings.transfer.name(), findings.found_curve->spread},
                                {"srgb", findings.found_curve->spread_first}};
  if (findings.daylight) file["water_type"] = color::name_of(findings.daylight->type);
  for (const color::BrightnessAt& layer : findings.brightness)
    file["brightness_by_way"].push_back(describe(layer));
  std::visit(
      [&](const auto& water) {
        for (std::size_t k = 0; k < 3; ++k)
          file["channels"][kNames[k]] = describe(water.channels[k]);
      },
      findings.choice.model);
  return file;
}

}  // namespace

void write_findings(const std::filesystem::path& folder, const Findings& findings) {
  io::write_json(folder / "colors.json", describe(findings));
}

}  // namespace axial::apps
