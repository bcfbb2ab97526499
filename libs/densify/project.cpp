// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/project.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "io/openmvs/scene_files.h"

namespace axial::densify {
namespace {

void add_options(Fingerprint& print, const MatchOptions& options, int ignore_mask_label) {
  for (const std::uint64_t value :
       {static_cast<std::uint64_t>(options.warp), static_cast<std::uint64_t>(options.projection),
        static_cast<std::uint64_t>(options.sub_resolution_levels),
        static_cast<std::uint64_t>(options.iterations),
        static_cast<std::uint64_t>(options.geometric_iterations),
        static_cast<std::uint64_t>(options.postprocess),
        static_cast<std::uint64_t>(ignore_mask_label)})
    print.add(value);
}

// A number of the options and its name in the fingerprint.
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
NamedNumbers numbers_of_openmvs(const MatchOptions& options) {
  return {named("Descriptor Min Magnitude Threshold",
                std::sqrt(static_cast<double>(options.min_texture))),
          named("NCC Threshold Keep", options.keep_cost),
          named("Estimation Geometric Weight", options.geometric_weight),
          named("Speckle Size", options.speckles.min_pixels),
          named("Interpolate Gap Size", options.gaps.max_gap)};
}

// The numbers that are neither in numbers_of_openmvs() nor in add_options(). The structured
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
NamedNumbers filter_numbers(const MatchOptions& options) {
  const auto& [speckle_difference, min_pixels] = options.speckles;
  const auto& [max_gap, gap_difference] = options.gaps;
  return {named("speckles.max_difference", speckle_difference),
          named("gaps.max_difference", gap_difference)};
}

NamedNumbers all_numbers(const MatchOptions& options) {
  NamedNumbers all = numbers_of_openmvs(options);
  for (const NamedNumbers& more : {other_numbers(options), filter_numbers(options)})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

// A line for each number that differs from its default. The text is empty for the defaults.
std::string changed_numbers(const MatchOptions& options) {
  const NamedNumbers now = all_numbers(options), before = all_numbers({});
  std::string text;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (now[i].value != before[i].value) text += fmt::format("{} {}\n", now[i].name, now[i].value);
  return text;
}

}  // namespace

std::vector<std::size_t> part_of(std::span<const std::size_t> images, const StageJob& job) {
  std::size_t begin = 0, end = images.size();
  if (job.parts > 0) {
    end = images.size() * job.part / job.parts;
    begin = images.size() * (job.part - 1) / job.parts;
  }
  return {images.begin() + static_cast<std::ptrdiff_t>(begin),
          images.begin() + static_cast<std::ptrdiff_t>(end)};
}

bool all_pinholes(const Project& project) {
  return std::ranges::none_of(
      project.views, [](const View& view) { return view.camera.port || view.camera.distortion; });
}

std::filesystem::path depth_map_path(const Project& project, std::size_t image) {
  return project.options.files.working_folder / io::depth_map_name(project.views[image].id);
}

std::string fingerprint(const Project& project, const MatchOptions& options,
                        const survey::KeptContents& kept, const Context& context) {
  Fingerprint print;
  // The number is the version of the matching method and of the defaults of its settings.
  print.add("AxialMVS depth maps 12");
  add_options(print, options, project.options.ignore_mask_label);
  if (const std::string changed = changed_numbers(options); !changed.empty()) print.add(changed);
  const std::vector<std::string> contents = survey::contents_of_views(project, kept, context);
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
