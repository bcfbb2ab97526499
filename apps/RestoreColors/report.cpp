// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

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
  return {{"a_per_m", describe(channel.a)},
          {"b_per_m", describe(channel.b)},
          {"veil", describe(channel.veil)},
          {"determined", channel.determined},
          {"residual_in_sigmas", channel.residual}};
}

json describe(const color::LampChannel& channel) {
  return {{"loss_per_m", channel.loss},
          {"determined", channel.determined},
          {"residual_in_sigmas", channel.residual}};
}

const char* name_of(color::Light light) {
  return light == color::Light::sun ? "sun" : "lamp";
}

void log_channels(const color::SunWater& water) {
  for (std::size_t k = 0; k < 3; ++k) {
    const color::SunChannel& channel = water.channels[k];
    log_info("{}: loss a {:.3f} +- {:.3f} /m, veil B {:.3f} +- {:.3f}, b {:.3f} +- {:.3f} /m",
             kNames[k], channel.a.value, channel.a.sigma, channel.veil.value, channel.veil.sigma,
             channel.b.value, channel.b.sigma);
  }
}

void log_channels(const color::LampField& field) {
  for (std::size_t k = 0; k < 3; ++k)
    log_info("{}: loss {:.3f} /m, one way", kNames[k], field.channels[k].loss);
}

}  // namespace

void log_findings(const Findings& findings, const Context& context) {
  log_info("Light: {}{}", name_of(findings.choice.light),
           findings.light_given ? " (given)" : ", by the photographs");
  std::visit([](const auto& water) { log_channels(water); }, findings.choice.model);
  log_info("The light of a point differs between photographs by {:.1f} %; before, by {:.1f} %",
           100 * findings.spread, 100 * findings.raw_spread);
  const std::array<bool, 3> known = color::determined(findings.choice.model);
  for (std::size_t k = 0; k < 3; ++k)
    if (!known[k])
      context.warning(
          "the loss of {} light is not determined by the photographs: {} stays as it is", kNames[k],
          kNames[k]);
  if (!findings.grey_given)
    context.info(
        "White is an assumption: the seabed is taken for grey in the mean. --grey names "
        "something grey");
}

void write_findings(const std::filesystem::path& folder, const Findings& findings) {
  json file = {{"light", name_of(findings.choice.light)},
               {"light_given", findings.light_given},
               {"points", findings.points},
               {"observations", findings.observations},
               {"spread_before", findings.raw_spread},
               {"spread_after", findings.spread},
               {"determined_pixels", findings.known},
               {"white", findings.grey_given ? "grey patch" : "grey seabed"},
               {"gain", {findings.gain[0], findings.gain[1], findings.gain[2]}}};
  if (!findings.light_given)
    file["spread_of_models"] = {{"sun", findings.choice.sun_spread},
                                {"lamp", findings.choice.lamp_spread}};
  std::visit(
      [&](const auto& water) {
        for (std::size_t k = 0; k < 3; ++k)
          file["channels"][kNames[k]] = describe(water.channels[k]);
      },
      findings.choice.model);
  io::write_json(folder / "colors.json", file);
}

}  // namespace axial::apps
