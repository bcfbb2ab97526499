// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/project.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "densify/fingerprint.h"
#include "densify/neighbour_lists.h"
#include "densify/scene_memory.h"
#include "io/openmvs/point_source.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

void find_views(Project& project) {
  find_photographs(project);
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
void use_neighbour_lists(Project& project, const Settings& settings) {
  const std::vector<bool> named = read_neighbour_lists(settings.neighbour_lists, project.scene);
  for (std::size_t i = 0; i < named.size(); ++i) {
    ViewPreparation& preparation = project.preparations[i];
    if (named[i] && preparation.init_points.size() >= settings.selection.min_init_points)
      preparation.problem.clear();
  }
}

void tell(const SceneObserver& observer, const Project& project, bool own_region) {
  if (observer)
    observer({project.housing.has_value(), own_region, project.scene.region.has_value()});
}

void select_views(Project& project, const Settings& settings, const SceneObserver& observer) {
  Scene& scene = project.scene;
  const bool own_region = scene.region.has_value();
  if (!scene.region) scene.region = estimate_region(scene, settings.region);
  if (scene.region) scene.region = with_border(*scene.region, settings.roi_border);
  tell(observer, project, own_region);
  require_memory_to_score(scene, settings);
  project.preparations =
      score_neighbours(scene, settings.selection, console_progress("Scored neighbours"));
  if (!settings.neighbour_lists.empty()) use_neighbour_lists(project, settings);
  project.neighbours.resize(scene.images.size());
  project.sources.resize(scene.images.size());
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    if (!scene.images[i].calibrated) continue;
    if (!project.preparations[i].usable()) {
      log_warning("{}: left out: {}", scene.images[i].path, project.preparations[i].problem);
      continue;
    }
    project.neighbours[i] = filter_neighbours(scene.images[i].neighbours, settings.selection);
    project.sources[i] =
        choose_source_views(project.neighbours[i], settings.number_views, settings.selection);
    if (project.sources[i].empty())
      log_warning("{}: left out: {}", scene.images[i].path,
                  why_no_source_view(scene.images[i].neighbours, settings.selection));
    else
      project.references.push_back(i);
  }
  if (project.references.empty())
    fail("{}: no image has neighbours to be matched with", settings.survey.files.scene.string());
}

}  // namespace

survey::Channels channels_of(const Settings& settings) {
  return needs_colors(settings) ? survey::Channels::both : survey::Channels::grey;
}

std::vector<std::size_t> part_of(std::span<const std::size_t> images, const Settings& settings) {
  std::size_t begin = 0, end = images.size();
  if (settings.parts > 0) {
    end = images.size() * settings.part / settings.parts;
    begin = images.size() * (settings.part - 1) / settings.parts;
  }
  return {images.begin() + static_cast<std::ptrdiff_t>(begin),
          images.begin() + static_cast<std::ptrdiff_t>(end)};
}

bool all_pinholes(const Project& project) {
  return std::ranges::none_of(
      project.views, [](const View& view) { return view.camera.port || view.camera.distortion; });
}

fs::path housing_file(const Settings& settings) {
  return io::housing_file(settings.survey.files);
}

Project load_scene(const Settings& settings) {
  require_memory_to_read(settings);
  survey::Options options = settings.survey;
  options.has_memory_limit = false;  // require_memory_to_read() has checked more than the scene
  Project project;
  static_cast<survey::Survey&>(project) = survey::open_scene(options);
  project.lenses = io::lenses_of(project.scene, settings.output);
  if (!settings.point_cloud.empty())
    io::use_point_cloud(project.scene, project.frame, settings.point_cloud);
  return project;
}

Project load_project(const Settings& settings, const SceneObserver& observer) {
  Project project = load_scene(settings);
  find_views(project);
  check_ids(project);
  select_views(project, settings, observer);
  project.part = part_of(project.references, settings);
  project.fingerprint = fingerprint(project, settings);
  return project;
}

void write_cameras_beside_output(const Project& project, const Settings& settings) {
  io::write_cameras_beside(settings.output, project, project.lenses, settings.survey.files);
}

}  // namespace axial::densify
