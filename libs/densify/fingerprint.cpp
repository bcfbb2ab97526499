// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/fingerprint.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/hash.h"
#include "survey/fingerprint.h"

namespace axial::densify {
namespace {

void add_settings(Fingerprint& print, const Settings& settings) {
  const depth::PatchMatchOptions& matching = settings.matching;
  for (const std::uint64_t value :
       {static_cast<std::uint64_t>(matching.warp), static_cast<std::uint64_t>(settings.projection),
        static_cast<std::uint64_t>(matching.sub_resolution_levels),
        static_cast<std::uint64_t>(matching.iterations),
        static_cast<std::uint64_t>(settings.geometric_iterations),
        static_cast<std::uint64_t>(settings.postprocess),
        static_cast<std::uint64_t>(settings.survey.ignore_mask_label)})
    print.add(value);
}

// A number of the settings and its name in the fingerprint.
struct NamedNumber {
  const char* name;
  double value;
};
using NamedNumbers = std::vector<NamedNumber>;

template <class T>
NamedNumber named(const char* name, T value) {
  return {name, static_cast<double>(value)};
}

// The numbers that OpenMVS's file of settings has, under their titles there. The side files of
// existing depth maps hold fingerprints of these names, values and their order.
NamedNumbers numbers_of_openmvs(const Settings& settings) {
  const depth::PatchMatchOptions& matching = settings.matching;
  return {named("Descriptor Min Magnitude Threshold",
                std::sqrt(static_cast<double>(matching.min_texture))),
          named("NCC Threshold Keep", matching.keep_cost),
          named("Estimation Geometric Weight", matching.geometric_weight),
          named("Speckle Size", settings.speckles.min_pixels),
          named("Interpolate Gap Size", settings.gaps.max_gap)};
}

// The numbers that are neither in numbers_of_openmvs() nor in add_settings(). The structured
// bindings name all members: a new member does not compile until it has a name here.
NamedNumbers other_numbers(const depth::PatchMatchOptions& matching) {
  const auto& [warp, sub_resolution_levels, iterations, coarsest_side, sigma_color, sigma_space,
               min_texture, smoothness, prior_texture, coarse_pairs, first_pairs, later_pairs,
               last_pairs, refinement_shrink, restart_trials, refinement_pixels, refinement_angle,
               good_cost, fair_cost, bad_cost, search_planes, search_pairs, certain_cost, keep_cost,
               geometric_weight, geometric_limit] = matching;
  const auto& [depth_sigma, depth_bonus, normal_sigma, normal_bonus] = smoothness;
  return {named("coarsest_side", coarsest_side),
          named("sigma_color", sigma_color),
          named("sigma_space", sigma_space),
          named("smoothness.depth_sigma", depth_sigma),
          named("smoothness.depth_bonus", depth_bonus),
          named("smoothness.normal_sigma", normal_sigma),
          named("smoothness.normal_bonus", normal_bonus),
          named("prior_texture", prior_texture),
          named("coarse_pairs", coarse_pairs),
          named("first_pairs", first_pairs),
          named("later_pairs", later_pairs),
          named("last_pairs", last_pairs),
          named("refinement_shrink", refinement_shrink),
          named("restart_trials", restart_trials),
          named("refinement_pixels", refinement_pixels),
          named("refinement_angle", refinement_angle),
          named("good_cost", good_cost),
          named("fair_cost", fair_cost),
          named("bad_cost", bad_cost),
          named("search_planes", search_planes),
          named("search_pairs", search_pairs),
          named("certain_cost", certain_cost),
          named("geometric_limit", geometric_limit)};
}

// As other_numbers(), of the filters.
NamedNumbers filter_numbers(const Settings& settings) {
  const auto& [speckle_difference, min_pixels] = settings.speckles;
  const auto& [max_gap, gap_difference] = settings.gaps;
  return {named("speckles.max_difference", speckle_difference),
          named("gaps.max_difference", gap_difference)};
}

NamedNumbers all_numbers(const Settings& settings) {
  NamedNumbers all = numbers_of_openmvs(settings);
  for (const NamedNumbers& more : {other_numbers(settings.matching), filter_numbers(settings)})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

// A line for each number that differs from its default. The text is empty for the defaults.
std::string changed_numbers(const Settings& settings) {
  const NamedNumbers now = all_numbers(settings), before = all_numbers(Settings());
  std::string text;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (now[i].value != before[i].value) text += fmt::format("{} {}\n", now[i].name, now[i].value);
  return text;
}

// Runs with `until` or `plan` for all images write the fingerprints of photographs to a file of the
// working folder. Runs for parts read the file.
survey::KeptContents kept_contents(const Settings& settings) {
  const bool is_part = settings.parts > 0 || settings.tile > 0;
  const bool is_kept = is_part || !settings.until.empty() || !settings.plan.empty();
  return {settings.survey.files.working_folder / "depth_inputs.json", is_kept, is_kept && !is_part};
}

}  // namespace

std::string fingerprint(const Project& project, const Settings& settings) {
  Fingerprint print;
  // The number is the version of the matching method and of the defaults of its settings.
  print.add("AxialMVS depth maps 12");
  add_settings(print, settings);
  if (const std::string changed = changed_numbers(settings); !changed.empty()) print.add(changed);
  const std::vector<std::string> contents =
      survey::contents_of_views(project, kept_contents(settings));
  for (std::size_t i = 0; i < project.views.size(); ++i) {
    survey::add_view(print, project, i, contents[i]);
    for (const auto* list : {&project.neighbours[i], &project.sources[i]}) {
      print.add(static_cast<std::uint64_t>(list->size()));
      for (const ViewScore& neighbour : *list) print.add(std::uint64_t{neighbour.image});
    }
    for (const std::uint32_t point : project.preparations[i].init_points)
      for (const float value : project.scene.points[point].position)
        print.add(static_cast<double>(value));
  }
  return print.hex();
}

}  // namespace axial::densify
