// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/densify.h"

#include <algorithm>
#include <set>

#include "base/log.h"
#include "base/memory.h"
#include "base/output_lock.h"
#include "base/parallel.h"
#include "densify/agreement_check.h"
#include "densify/cloud_exports.h"
#include "densify/depth_stage.h"
#include "densify/existing_maps.h"
#include "densify/fusion_stage.h"
#include "densify/memory_plan.h"
#include "densify/neighbour_lists.h"
#include "densify/outputs.h"
#include "densify/pinhole_export.h"
#include "densify/pinhole_folder.h"
#include "densify/project.h"
#include "densify/tile_files.h"
#include "densify/tile_stage.h"
#include "densify/work_plan.h"
#include "io/openmvs/mvs.h"
#include "io/ply/ply.h"
#include "survey/image_store.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

Report export_points(const Settings& settings) {
  const WrittenCloud cloud = export_cloud(load_scene(settings), settings);
  return {Result::point_export, cloud.file, cloud.points};
}

Report write_lists(const Settings& settings, const SceneObserver& observer) {
  const Project project = load_project(settings, observer);
  check_outputs(project, settings);
  write_neighbour_lists(settings.neighbour_lists_output, project.scene);
  return {Result::neighbour_lists, {}};
}

ExistingMaps checked_maps(Project& project, const Settings& settings) {
  ExistingMaps existing = find_existing_maps(project, settings);
  if (settings.make_maps && settings.tile > 0)
    require_final_maps(project, settings, existing);
  else if (settings.make_maps)
    check_overwriting(project, settings, existing);
  else
    keep_images_with_maps(project, settings, existing);
  return existing;
}

// Runs that make parts of the maps or read complete maps can share a folder. A run that makes all
// maps removes those of earlier stages, which another run would miss.
LockUse use_of_maps(const Project& project, const Settings& settings,
                    const ExistingMaps& existing) {
  if (!settings.make_maps || settings.parts > 0) return LockUse::shared;
  const std::string made_from = final_made_from(project, settings);
  const bool complete = std::ranges::all_of(project.references, [&](std::size_t image) {
    return existing[image].origin == io::DmapOrigin::ours && existing[image].made_from == made_from;
  });
  return complete ? LockUse::shared : LockUse::alone;
}

// The name by which runs lock the depth maps of a folder.
fs::path maps_in(const Settings& settings) {
  return settings.survey.files.working_folder / "depth_maps";
}

// Runs for a part, a stage or a list do not write the output itself.
LockUse use_of_output(const Settings& settings) {
  const bool is_part = settings.tile > 0 || !settings.until.empty() || !settings.plan.empty() ||
                       !settings.neighbour_lists_output.empty();
  return is_part ? LockUse::shared : LockUse::alone;
}

// If the maps are not fused, the sparse cloud gets the dense cloud's name, as in OpenMVS.
std::size_t write_sparse_cloud(const Project& project, const Settings& settings,
                               const fs::path& ply) {
  io::write_cloud_ply(ply, cloud_of(project.scene), true, placement_of(project, settings));
  return project.scene.points.size();
}

// The images of the part that this run makes, and their sources.
std::vector<std::size_t> images_of_part(const Project& project) {
  std::set<std::size_t> images(project.part.begin(), project.part.end());
  for (const std::size_t image : project.part)
    for (const ViewScore& source : project.sources[image]) images.insert(source.image);
  return {images.begin(), images.end()};
}

// Makes or uses the depth maps of the run's images.
void prepare_maps(const Project& project, const Settings& settings, const MemoryPlan& plan,
                  const ExistingMaps& existing, survey::ImageStore& images) {
  // The first stage reads the images of its part. Later stages need not check them again.
  if (settings.parts == 0)
    images.check_all(plan.decodes);
  else if (stages_to_make(settings) == 1)
    images.check(images_of_part(project), plan.decodes);
  if (settings.make_maps)
    make_depth_maps(project, settings, plan, existing, images);
  else
    check_agreement(project, settings, plan, false, [&](std::size_t image) {
      return read_final_map(project, settings, existing, image, images.mask(image));
    });
}

// The images are in memory only in this function.
std::size_t make_cloud(const Project& project, const Settings& settings, const MemoryPlan& plan,
                       const ExistingMaps& existing, const fs::path& ply) {
  survey::ImageStore images(project, channels_of(settings), plan.cached_images);
  prepare_maps(project, settings, plan, existing, images);
  return settings.fuse ? write_cloud(project, settings, plan, existing, images, ply)
                       : write_sparse_cloud(project, settings, ply);
}

void remove_depth_maps(const Project& project, const Settings& settings) {
  for (const std::size_t image : project.references) {
    const fs::path file = depth_map_path(project, settings, image);
    fs::remove(file);
    fs::remove(file.string() + ".json");
  }
}

Report make_stage(const Settings& settings, const SceneObserver& observer) {
  stages_to_make(settings);  // throws for a wrong name
  Project project = load_project(settings, observer);
  const ExistingMaps existing = checked_maps(project, settings);
  const OutputLock maps(maps_in(settings), use_of_maps(project, settings, existing));
  const MemoryPlan plan = plan_memory(project, settings);
  check_outputs(project, settings);
  survey::ImageStore images(project, channels_of(settings), plan.cached_images);
  prepare_maps(project, settings, plan, existing, images);
  return {Result::stage, {}, 0, project.part.size()};
}

Report write_plan(const Settings& settings, const SceneObserver& observer) {
  const Project project = load_project(settings, observer);
  check_outputs(project, settings);
  write_work_plan(settings.plan, project, settings);
  return {Result::plan, {}};
}

// Depth maps and images were checked when the maps were made.
Report make_tile(const Project& project, const Settings& settings, const MemoryPlan& plan,
                 const ExistingMaps& existing) {
  map_large_blocks();
  survey::ImageStore images(project, channels_of(settings), plan.cached_images);
  const CloudCounts counts = write_tile({project, settings, plan, existing, images});
  return {Result::tile, tile_file(settings, settings.tile), counts.points,
          project.references.size(), true};
}

Report reconstruct(const Settings& settings, const SceneObserver& observer) {
  Project project = load_project(settings, observer);
  const ExistingMaps existing = checked_maps(project, settings);
  const OutputLock maps(maps_in(settings), use_of_maps(project, settings, existing));
  const MemoryPlan plan = plan_memory(project, settings);
  check_outputs(project, settings);
  check_pinhole_export(project, settings);
  if (settings.tile > 0) return make_tile(project, settings, plan, existing);

  const fs::path ply = fs::path(settings.output).replace_extension(".ply");
  const std::size_t points = make_cloud(project, settings, plan, existing, ply);
  return_freed_memory();  // the images' memory is needed to write the scene
  write_cameras_beside_output(project, settings);
  io::write_mvs(settings.output, project.scene, settings.survey.files.working_folder);
  log_info("{}: {} points", ply.string(), points);
  if (settings.fuse && points == 0)
    log_warning(
        "The cloud is empty: no point was seen by {} views (see {}), or masks and the region of "
        "interest exclude all points",
        settings.fusion.min_views, settings.name_of("fusion.min_views"));
  export_pinholes(project, settings, plan, existing, ply);
  if (settings.fuse) remove_tiles(settings);
  if (settings.remove_dmaps && settings.fuse) remove_depth_maps(project, settings);
  return {settings.fuse ? Result::dense_cloud : Result::sparse_cloud, ply, points,
          project.references.size(), all_pinholes(project)};
}

}  // namespace

Report densify(const Settings& settings, const SceneObserver& observer) {
  share_one_heap();
  const ThreadLimit threads(settings.max_threads);
  // If its folder cannot be made, require_writable reports it.
  const OutputLock lock = lock_output(settings.output, use_of_output(settings));
  check_outputs(settings);
  if (only_exports(settings)) return export_points(settings);
  if (!settings.neighbour_lists_output.empty()) return write_lists(settings, observer);
  if (!settings.plan.empty()) return write_plan(settings, observer);
  if (!settings.until.empty()) return make_stage(settings, observer);
  return reconstruct(settings, observer);
}

}  // namespace axial::densify
