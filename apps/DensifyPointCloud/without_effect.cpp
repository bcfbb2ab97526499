// SPDX-License-Identifier: GPL-3.0-or-later
#include "without_effect.h"

#include <initializer_list>
#include <string>

#include "base/program/option_values.h"

namespace axial::apps {
namespace {

using Names = std::initializer_list<const char*>;

constexpr Names kMatching{"sub-resolution-levels", "iters",         "geometric-iters",
                          "postprocess-dmaps",     "projection",    "warp",
                          "overwrite-dmaps",       "match-restored"};
constexpr Names kMapSize{"resolution-level", "max-resolution", "min-resolution", "number-views"};
constexpr Names kFusion{"number-views-fuse",    "estimate-colors", "estimate-normals",
                        "estimate-uncertainty", "crop-to-roi",     "remove-dmaps"};
constexpr Names kImages{"resolution-level", "max-resolution",     "min-resolution", "number-views",
                        "mask-path",        "ignore-mask-label",  "bit-depth",      "estimate-roi",
                        "roi-border",       "view-neighbors-file"};

void warn_of(const Options& options, Names names, const std::string& cause) {
  warn_without_effect(options.parsed, names, cause);
}

// The options of fusion, and those of colours that are not matched either.
void warn_of_fusion(const Options& options, const std::string& cause) {
  warn_of(options, kFusion, cause);
  if (!options.settings.survey.match_colors) warn_of(options, {"colors"}, cause);
}

// If several exports are asked for, the first one is made.
std::string export_that_is_made(const densify::ExportJob& job) {
  if (job.filter_point_cloud < 0) return "filter-point-cloud";
  return job.export_number_views != 0 ? "export-number-views" : "estimate-scale";
}

void warn_of_options_an_export_ignores(const Options& options, const densify::ExportJob& job) {
  const std::string made = export_that_is_made(job);
  const std::string with = "with --" + made + ", which writes existing points";
  if (made == "filter-point-cloud")
    warn_of(options, {"export-number-views", "estimate-scale"}, with);
  if (made == "export-number-views") warn_of(options, {"estimate-scale"}, with);
  for (const Names& names : {kMatching, kFusion, kImages, Names{"colors"}})
    warn_of(options, names, with);
  warn_of(options, {"fusion-mode", "output-view-neighbors-file"}, with);
}

}  // namespace

void warn_of_options_without_effect(const Options& options) {
  const densify::Options& settings = options.settings;
  if (settings.survey.files.ports == io::PortChoice::ignored)
    warn_of(options, {"housing"}, "with --camera-model pinhole");
  if (const auto* job = settings.job_as<densify::ExportJob>())
    return warn_of_options_an_export_ignores(options, *job);
  if (settings.job_as<densify::NeighbourListsJob>()) {
    for (const Names& names : {kMatching, kFusion, Names{"colors"}})
      warn_of(options, names, "with --output-view-neighbors-file, which matches no images");
    return;
  }
  if (const auto* job = settings.job_as<densify::StageJob>()) {
    if (job->parts > 0) warn_of(options, {"report-file"}, "with --part, which checks nothing");
    warn_of_fusion(options, "with --until, which makes no cloud");
    warn_of(options, {"tiles"}, "with --until, which makes no cloud");
  }
  if (settings.job_as<densify::PlanJob>())
    warn_of(options, {"report-file", "overwrite-dmaps", "remove-dmaps"}, "with --plan");
  else
    warn_of(options, {"plan-parts"}, "without --plan");
  if (!settings.matching.make_maps)
    for (const Names& names : {kMatching, kMapSize})
      warn_of(options, names, "with --fusion-mode -1, which uses depth maps unchanged");
  if (settings.job_as<densify::TileJob>())
    warn_of(options, {"remove-dmaps", "report-file"}, "with --tile, which makes no whole cloud");
  if (!settings.fusion.fuse)
    warn_of_fusion(options, "with --fusion-mode 1, which makes only depth maps");
  else if (!settings.fusion.needs_colors() && settings.output.pinhole_export.empty() &&
           !(settings.survey.match_colors && settings.matching.make_maps))
    warn_of(options, {"colors"}, "with --estimate-colors 0");
}

void warn_of_options_without_effect(const Options& options, const densify::SceneFacts& facts) {
  if (facts.own_region)
    warn_of(options, {"estimate-roi"}, "on a scene that already has a region of interest");
  if (!facts.behind_ports) warn_of(options, {"projection"}, "in air: no image is behind a port");
  if (!facts.region)
    warn_of(options, {"roi-border"}, "without a region of interest (see --estimate-roi)");
}

}  // namespace axial::apps
