// SPDX-License-Identifier: GPL-3.0-or-later
#include "white.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "base/context.h"
#include "base/error.h"
#include "base/order_statistics.h"
#include "color/chart.h"
#include "photographs.h"
#include "survey/photograph_names.h"

namespace axial::apps {
namespace {

// The view of the photograph whose path ends with `name`. Error that begins with `option` if there
// is not exactly one.
std::size_t view_named(const std::string& name, const char* option, const survey::Survey& survey) {
  const std::vector<std::size_t> found = survey::views_named(name, survey);
  if (found.empty()) fail("{} {}: no photograph has this name", option, name);
  if (found.size() > 1)
    fail("{} {}: several photographs have this name; give a folder, too", option, name);
  return found.front();
}

// A photograph whose light is restored without white.
struct SeenLight {
  SeenLight(const survey::Survey& survey, const color::SeenSurface& surface,
            const Findings& findings, std::size_t view)
      : photograph(read_light(survey, view, findings.transfer)),
        sights(surface.sights(posed(survey.views[view]))),
        exposure(exposure_of(findings, view)),
        model(findings.choice.model) {
    usable = photograph.light.clone();
    color::mark_unusable(usable, photograph.mask, findings.transfer);
  }

  // The mean light of the surface, of pixels where it is known; NaN if there is none.
  Eigen::Array3f mean(std::span<const cv::Point> pixels) const {
    Eigen::Array3f sum = Eigen::Array3f::Zero();
    int count = 0;
    for (const cv::Point& pixel : pixels) {
      const cv::Vec3f& light = usable(pixel);
      const Eigen::Array3f color = Eigen::Array3f(light[0], light[1], light[2]) / exposure;
      const color::Sight& sight = sights.at(pixel.x, pixel.y);
      if (!color.isFinite().all() || !(sight.way > 0)) continue;
      sum += color::surface_light(model, sight, color);
      ++count;
    }
    if (count == 0) return Eigen::Array3f::Constant(std::numeric_limits<float>::quiet_NaN());
    return sum / static_cast<float>(count);
  }

  PhotographLight photograph;
  cv::Mat3f usable;
  color::SightImage sights;
  Eigen::Array3f exposure;
  const color::WaterModel& model;
};

// Sets the gain of the channels that the model determines. The others stay as they are.
void set_gain(const Eigen::Array3f& gain, Findings& findings) {
  const std::array<bool, 3> known = color::determined(findings.choice.model);
  for (int k = 0; k < 3; ++k)
    if (known[static_cast<std::size_t>(k)]) findings.gain[k] = gain[k];
}

void use_grey(const GreyPatch& grey, const SeenLight& light, Findings& findings) {
  std::vector<cv::Point> pixels;
  for (int y = grey.part.y; y < grey.part.br().y; ++y)
    for (int x = grey.part.x; x < grey.part.br().x; ++x) pixels.emplace_back(x, y);
  const Eigen::Array3f mean = light.mean(pixels);
  const std::array<bool, 3> known = color::determined(findings.choice.model);
  float brightness = 0, of_patch = 0;  // sums of the gains of the channels that are known
  for (int k = 0; k < 3; ++k) {
    if (!known[static_cast<std::size_t>(k)]) continue;
    if (!(mean[k] > 0))
      fail("--grey {}: the light of this part is not known: it is clipped, or no surface is there",
           grey.image);
    brightness += findings.gain[k];
    of_patch += 1 / mean[k];
  }
  set_gain(brightness / of_patch * mean.inverse(), findings);
  findings.white = White::grey_part;
}

// The charts of one photograph, whether they are charts or not.
std::vector<SeenChart> charts_in(const std::string& name, const SeenLight& light,
                                 const Findings& findings) {
  // Charts are looked for with the curve of sRGB.
  const color::Restored restored =
      color::restore(light.photograph.light, light.photograph.mask, light.sights, light.model,
                     {findings.gain, color::Transfer(), 8, light.exposure});
  std::vector<SeenChart> charts;
  for (const color::Chart& chart : color::find_charts(restored.pixels)) {
    SeenChart seen{name, {}, Eigen::Array3f::Zero(), 0};
    for (std::size_t patch = 0; patch < color::kPatches; ++patch)
      seen.lights[patch] = light.mean(color::pixels_of_patch(chart, patch, light.usable.size()));
    seen.gain = color::gain_of(seen.lights);
    charts.push_back(seen);
  }
  return charts;
}

// Why a chart cannot be used; empty if it can.
std::string fault_of(const SeenChart& chart, const Findings& findings) {
  const std::array<bool, 3> known = color::determined(findings.choice.model);
  for (std::size_t k = 0; k < 3; ++k)
    if (known[k] && !std::isfinite(chart.gain[static_cast<Eigen::Index>(k)]))
      return "the light of its grey patches is not known: it is clipped, or no surface is there";
  const double likeness = color::likeness(chart.lights, known);
  if (likeness >= color::kLeastLikeness) return "";
  return fmt::format(
      "its colours are not those of a chart of 24 patches: their correlation is {:.2f}, and must "
      "be {} or more",
      likeness, color::kLeastLikeness);
}

void use_charts(const Settings& settings, const survey::Survey& survey,
                const color::SeenSurface& surface, std::span<const std::size_t> views,
                Findings& findings, const Context& context) {
  ProgressCounter progress(context.stage("Looking for colour charts"), views.size());
  const std::vector<std::filesystem::path> names = survey::photograph_names(survey);
  std::string fault;  // of the last chart that cannot be used
  for (const std::size_t view : views) {
    const std::string name = names[view].generic_string();
    const SeenLight light(survey, surface, findings, view);
    for (SeenChart& chart : charts_in(name, light, findings)) {
      const std::string why = fault_of(chart, findings);
      if (why.empty()) {
        findings.charts.push_back(std::move(chart));
        continue;
      }
      fault = fmt::format("the chart in {} is not used: {}", name, why);
      context.info("{}", fault);
    }
    progress.add();
  }
  if (findings.charts.empty() && !fault.empty()) fail("--chart {}: {}", settings.chart, fault);
  if (findings.charts.empty())
    fail("--chart {}: no chart of 24 patches was found in {}", settings.chart,
         views.size() == 1 ? "this photograph" : "the photographs");
  Eigen::Array3f gain;
  for (int k = 0; k < 3; ++k) {
    std::vector<float> gains;
    for (const SeenChart& chart : findings.charts) gains.push_back(chart.gain[k]);
    gain[k] = static_cast<float>(mean_median(std::move(gains)));
  }
  set_gain(gain, findings);
  for (SeenChart& chart : findings.charts)
    chart.error = color::chart_error(chart.lights, findings.gain);
  findings.white = White::charts;
}

}  // namespace

WhiteViews white_views(const Settings& settings, const survey::Survey& survey) {
  WhiteViews views;
  if (settings.grey) {
    const GreyPatch& grey = *settings.grey;
    views.grey = view_named(grey.image, "--grey", survey);
    const CameraModel& camera = survey.views[views.grey].camera;
    const cv::Rect all(0, 0, camera.width, camera.height);
    if ((grey.part & all) != grey.part)
      fail("--grey {}: the part lies outside the photograph of {} x {} pixels", grey.image,
           all.width, all.height);
  }
  if (settings.chart == "all") {
    views.charts.resize(survey.views.size());
    std::iota(views.charts.begin(), views.charts.end(), std::size_t{0});
  } else if (!settings.chart.empty()) {
    views.charts.push_back(view_named(settings.chart, "--chart", survey));
  }
  return views;
}

void find_white(const Settings& settings, const survey::Survey& survey,
                const color::SeenSurface& surface, const WhiteViews& views, Findings& findings,
                const Context& context) {
  if (settings.grey)
    use_grey(*settings.grey, SeenLight(survey, surface, findings, views.grey), findings);
  if (!views.charts.empty()) use_charts(settings, survey, surface, views.charts, findings, context);
}

}  // namespace axial::apps
