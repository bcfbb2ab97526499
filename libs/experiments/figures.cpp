// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's figures 2 to 4: errors of projections, and errors of patches in a tiny image, in the
// paper's image of 100 x 100 pixels and in an image of real size.
#include <fmt/format.h>

#include <cmath>

#include "experiments/experiment.h"
#include "experiments/patch_error.h"
#include "experiments/projection_error.h"

namespace axial::experiments {
namespace {

// Figure 2.

constexpr int kRoundTripSize = 1000;

std::vector<Series> round_trip_series() {
  return {{"fov_degrees", {50, 80, 100, 120}},
          {"distance_mm", {2, 20, 50, 100}},
          {"tilt_degrees", {0, 5, 10, 20}},
          {"n_glass", {1.49, 1.52}},
          {"n_water", {1.333, 1.34}}};
}

Json to_json(const RoundTrips& trips) {
  const Distribution& errors = trips.errors;
  return {{"mean", errors.mean()},         {"median", errors.quantile(0.5)},
          {"p95", errors.quantile(0.95)},  {"largest", errors.largest()},
          {"count", errors.count()},       {"missed", trips.missed},
          {"bins_upper", errors.upper()},  {"bins", errors.counts()},
          {"beyond_bins", errors.beyond()}};
}

Part round_trip_part(const Variation& variation, double step) {
  const CameraSetup camera = variation.setup.camera;
  return {part_name(variation.series, variation.value, 1),
          {{"version", 1}, {"camera", to_json(camera)}, {"size", kRoundTripSize}, {"step", step}},
          [camera, step]() -> Json {
            const ProjectionErrors errors = projection_errors(camera, kRoundTripSize, step);
            return {{"line_search", to_json(errors.line_search)}, {"exact", to_json(errors.exact)}};
          }};
}

// Figure 3.

constexpr int kTinySize = 10;
constexpr int kTinyBorder = 12;  // of both images: most patches lie in the second image

const char* warp_name(Warp warp) {
  return kWarpNames[static_cast<std::size_t>(warp)];
}

Part tiny_part(int number) {
  const StereoSetup setup{number, {}, 0};
  return {fmt::format("setup{}", number),
          {{"version", 2}, {"setup", to_json(setup)}, {"size", kTinySize}, {"border", kTinyBorder}},
          [setup]() -> Json {
            const WarpStudy study(setup, kTinySize + 2 * kTinyBorder, kTinySize);
            Json maps = Json::object();
            for (const Warp warp :
                 {Warp::kPapers, Warp::kExactCentre, Warp::kScaled, Warp::kFirstOrder})
              maps[warp_name(warp)] = exploded_error_map(study, warp, kTinyBorder);
            return {{"texels_across", kTinySize * kPatchSide}, {"errors", maps}};
          }};
}

// Figure 4.

constexpr int kPapersSize = 100, kRealSize = 2048;

std::vector<Series> patch_series() {
  return {{"fov_degrees", {50, 80, 100, 110}}, {"distance_mm", {2, 20, 50, 100}},
          {"tilt_degrees", {0, 3, 6, 10}},     {"plane_degrees", {0, 20, 40, 60}},
          {"n_glass", {1.49, 1.52}},           {"n_water", {1.333, 1.34}}};
}

// The images of real size. `quick`: only the setups that docs/paper compares with its prototype,
// because the table of rays of each setup has four million pixels.
std::vector<Series> real_series(bool quick) {
  if (!quick) return patch_series();
  return {{"fov_degrees", {80, 100}},
          {"distance_mm", {20, 100}},
          {"tilt_degrees", {0, 6}},
          {"plane_degrees", {0, 40}}};
}

Json to_json(const StudyStatistics& statistics) {
  Json warps = Json::object();
  for (std::size_t w = 0; w < kWarps; ++w) {
    const WarpStatistics& warp = statistics.warps[w];
    warps[kWarpNames[w]] = {
        {"mean", warp.mean}, {"largest", warp.largest}, {"mean_at_centre", warp.mean_at_centre}};
  }
  return {{"centres", statistics.centres},
          {"warps", warps},
          {"rounding_over_warp", statistics.rounding_over_warp},
          {"papers_rounding_over_warp", statistics.papers_rounding_over_warp},
          {"middle_not_least", statistics.middle_not_least}};
}

// Whole millionths of a pixel: short in a file, and -1 stays -1.
Json whole_numbers(const std::vector<double>& map) {
  Json list = Json::array();
  for (const double value : map) list.push_back(value < 0 ? -1 : std::lround(1e6 * value));
  return list;
}

Json measure_papers_size(const StereoSetup& setup) {
  const WarpStudy study(setup, kPapersSize + 2 * kPatchReach, kPapersSize);
  Json result = to_json(study_statistics(study, 1));
  for (const Warp warp : {Warp::kPapers, Warp::kFirstOrder})
    result["maps_in_millionths"][warp_name(warp)] = whole_numbers(patch_error_map(study, warp));
  return result;
}

Part papers_part(const Variation& variation) {
  const StereoSetup setup = variation.setup;
  return {
      part_name(variation.series, variation.value, setup.number) + "_100px",
      {{"version", 1}, {"setup", to_json(setup)}, {"size", kPapersSize}, {"border", kPatchReach}},
      [setup] { return measure_papers_size(setup); }};
}

Part real_part(const Variation& variation, int step) {
  const StereoSetup setup = variation.setup;
  return {part_name(variation.series, variation.value, setup.number) + "_2048px",
          {{"version", 1}, {"setup", to_json(setup)}, {"size", kRealSize}, {"step", step}},
          [setup, step] { return to_json(study_statistics(WarpStudy(setup, kRealSize), step)); }};
}

}  // namespace

Experiment figure2(bool quick) {
  Experiment experiment{"figure2", {}};
  // Coarse steps still cover every tenth of a pixel.
  for (const Variation& variation : variations(round_trip_series(), 1))
    experiment.parts.push_back(round_trip_part(variation, quick ? 1.7 : 0.1));
  return experiment;
}

// `quick` changes nothing: there are only 200 patches.
Experiment figure3(bool) {
  return {"figure3", {tiny_part(1), tiny_part(2)}};
}

Experiment figure4(bool quick) {
  Experiment experiment{"figure4", {}};
  for (const int setup : {1, 2}) {
    for (const Variation& variation : variations(patch_series(), setup))
      experiment.parts.push_back(papers_part(variation));
    for (const Variation& variation : variations(real_series(quick), setup))
      experiment.parts.push_back(real_part(variation, quick ? 61 : 7));
  }
  return experiment;
}

}  // namespace axial::experiments
