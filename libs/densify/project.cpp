// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/project.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/first_error.h"
#include "base/log.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "densify/fingerprint.h"
#include "densify/masks.h"
#include "densify/neighbour_lists.h"
#include "densify/scene_memory.h"
#include "io/images/bit_depth.h"
#include "io/images/image.h"
#include "io/images/photograph_size.h"
#include "io/openmvs/point_source.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

View load_view(const SceneImage& image, std::size_t index, const Settings& settings) {
  View view;
  view.id = image.id == kNoId ? static_cast<std::uint32_t>(index) : image.id;
  view.file = io::read_image_header(image.path);
  const cv::Size size =
      working_size(view.file.size.width, view.file.size.height, settings.resolution);
  view.camera = image.camera.resized(size.width, size.height);
  view.pose = image.pose;
  return view;
}

void find_bit_depth(Project& project, const Settings& settings) {
  std::vector<fs::path> photographs;
  std::vector<io::ImageHeader> headers;
  for (std::size_t i = 0; i < project.views.size(); ++i) {
    if (!project.scene.images[i].calibrated) continue;
    photographs.emplace_back(project.scene.images[i].path);
    headers.push_back(project.views[i].file);
  }
  project.bit_depth =
      io::common_bit_depth(photographs, headers, settings.bit_depth, settings.name_of("bit_depth"));
}

void check_sizes(const Project& project) {
  std::vector<io::PhotographSize> sizes;
  for (std::size_t i = 0; i < project.views.size(); ++i) {
    const SceneImage& image = project.scene.images[i];
    if (image.calibrated)
      sizes.push_back(
          {image.path, project.views[i].file.size, {image.camera.width, image.camera.height}});
  }
  io::check_photograph_sizes(sizes);
}

void load_views(Project& project, const Settings& settings) {
  const std::size_t count = project.scene.images.size();
  project.views.resize(count);
  FirstError error;
  parallel_for(count, [&](std::size_t i) {
    if (project.scene.images[i].calibrated)
      error.run(i, [&] { project.views[i] = load_view(project.scene.images[i], i, settings); });
  });
  error.rethrow();
  check_sizes(project);
  choose_masks(project, settings);
  find_bit_depth(project, settings);
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
    fail("{}: no image has neighbours to be matched with", settings.input.string());
}

}  // namespace

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

namespace {

io::SceneFiles scene_files_of(const Settings& settings) {
  io::SceneFiles files{settings.input, settings.working_folder, settings.housing};
  files.ports = settings.camera == CameraChoice::pinhole     ? io::PortChoice::ignored
                : settings.camera == CameraChoice::flat_port ? io::PortChoice::flat
                : settings.refractive                        ? io::PortChoice::required
                                                             : io::PortChoice::automatic;
  files.allow_missing = settings.allow_missing;
  files.name_of = settings.name_of;
  return files;
}

}  // namespace

fs::path housing_file(const Settings& settings) {
  return io::housing_file(scene_files_of(settings));
}

Project load_scene(const Settings& settings) {
  require_memory_to_read(settings);
  Project project;
  static_cast<io::SceneWithCameras&>(project) =
      io::read_scene_with_cameras(scene_files_of(settings));
  project.lenses = io::lenses_of(project.scene, settings.output);
  if (!settings.point_cloud.empty())
    io::use_point_cloud(project.scene, project.frame, settings.point_cloud);
  return project;
}

Project load_scene_and_headers(const Settings& settings) {
  Project project = load_scene(settings);
  load_views(project, settings);
  return project;
}

Project load_project(const Settings& settings, const SceneObserver& observer) {
  Project project = load_scene_and_headers(settings);
  check_ids(project);
  select_views(project, settings, observer);
  project.part = part_of(project.references, settings);
  project.fingerprint = fingerprint(project, settings);
  return project;
}

void write_cameras_beside_output(const Project& project, const Settings& settings) {
  io::write_cameras_beside(settings.output, project, project.lenses, scene_files_of(settings));
}

}  // namespace axial::densify
