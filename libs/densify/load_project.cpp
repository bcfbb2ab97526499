// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/load_project.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "densify/memory_plan.h"
#include "densify/neighbour_lists.h"
#include "io/openmvs/point_source.h"
#include "scene/region.h"

namespace axial::densify {
namespace {

void find_views(Project& project, const Context& context) {
  find_photographs(project, context);
  std::vector<View> views(project.scene.images.size());
  for (View& view : project.views) views[view.image] = std::move(view);
  project.views = std::move(views);
}

void check_ids(const Project& project) {
  std::set<std::uint32_t> seen;
  for (std::size_t i = 0; i < project.views.size(); ++i)
    if (project.scene.images[i].calibrated && !seen.insert(project.views[i].id).second)
      fail("image {}: ID {} is used twice, depth maps would overwrite each other",
           project.scene.images[i].path, project.views[i].id);
}

// Images with given neighbours need points of their own only for their depth range.
void use_neighbour_lists(Project& project, const ViewOptions& options, const Context& context) {
  const std::vector<bool> named =
      read_neighbour_lists(options.neighbour_lists, project.scene, context);
  for (std::size_t i = 0; i < named.size(); ++i) {
    ViewPreparation& preparation = project.preparations[i];
    if (named[i] && preparation.init_points.size() >= options.selection.min_init_points)
      preparation.problem.clear();
  }
}

void tell(const SceneObserver& observer, const Project& project, bool own_region) {
  if (observer)
    observer({project.housing.has_value(), own_region, project.scene.region.has_value()});
}

void select_views(Project& project, const ViewOptions& options, const SceneObserver& observer,
                  const Context& context) {
  Scene& scene = project.scene;
  const bool own_region = scene.region.has_value();
  if (!scene.region) scene.region = estimate_region(scene, options.region);
  if (scene.region) scene.region = with_border(*scene.region, options.roi_border);
  tell(observer, project, own_region);
  require_memory_to_score(scene, project.options, options.selection, context.memory());
  project.preparations =
      score_neighbours(scene, options.selection, context.stage("Scored neighbours"));
  if (!options.neighbour_lists.empty()) use_neighbour_lists(project, options, context);
  project.neighbours.resize(scene.images.size());
  project.sources.resize(scene.images.size());
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    if (!scene.images[i].calibrated) continue;
    if (!project.preparations[i].usable()) {
      context.warning("{}: left out: {}", scene.images[i].path, project.preparations[i].problem);
      continue;
    }
    project.neighbours[i] = filter_neighbours(scene.images[i].neighbours, options.selection);
    project.sources[i] =
        choose_source_views(project.neighbours[i], options.number_views, options.selection);
    if (project.sources[i].empty())
      context.warning("{}: left out: {}", scene.images[i].path,
                      why_no_source_view(scene.images[i].neighbours, options.selection));
    else
      project.references.push_back(i);
  }
  if (project.references.empty())
    fail_in(project.file(), "no image has neighbours to be matched with");
}

}  // namespace

Project load_scene(const survey::Options& survey, const std::filesystem::path& point_cloud,
                   const std::filesystem::path& output, bool for_export, const Context& context) {
  require_memory_to_read(survey, point_cloud, for_export, context.memory());  // more than the scene
  const Context unlimited(context, MemoryBudget());
  Project project;
  static_cast<survey::Survey&>(project) = survey::open_scene(survey, unlimited);
  project.lenses = io::lenses_of(project.scene, output);
  if (!point_cloud.empty()) io::use_point_cloud(project.scene, project.frame, point_cloud, context);
  return project;
}

Project load_project(const survey::Options& survey, const ViewOptions& options,
                     const std::filesystem::path& output, const SceneObserver& observer,
                     const Context& context) {
  Project project = load_scene(survey, options.point_cloud, output, false, context);
  find_views(project, context);
  check_ids(project);
  select_views(project, options, observer, context);
  return project;
}

}  // namespace axial::densify
