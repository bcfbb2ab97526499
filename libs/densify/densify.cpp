// SPDX-License-Identifier: GPL-3.0-or-later
#include "axial/densify.h"

#include <set>

#include "base/memory.h"
#include "base/output_lock.h"
#include "base/parallel.h"
#include "base/program/tiling.h"
#include "densify/agreement_check.h"
#include "densify/cloud_exports.h"
#include "densify/depth_stage.h"
#include "densify/fusion_stage.h"
#include "densify/load_project.h"
#include "densify/neighbour_lists.h"
#include "densify/outputs.h"
#include "densify/pinhole_export.h"
#include "densify/pinhole_folder.h"
#include "densify/work_plan.h"
#include "io/openmvs/mvs.h"
#include "io/ply/ply.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

// Runs for a stage or a plan of all images write the fingerprints of photographs to a file of the
// working folder. Runs for parts and tiles read the file.
survey::KeptContents kept_contents(const fs::path& working_folder, const Job& job) {
  const auto* stage = std::get_if<StageJob>(&job);
  const bool is_part = (stage && stage->parts > 0) || std::get_if<TileJob>(&job);
  const bool is_kept = is_part || stage || std::get_if<PlanJob>(&job);
  return {working_folder / "depth_inputs.json", is_kept, is_kept && !is_part};
}

Project load_with_fingerprint(const Options& options, const SceneObserver& observer,
                              const Context& context) {
  Project project =
      load_project(options.survey, options.views, options.output.scene, observer, context);
  const auto* stage = options.job_as<StageJob>();
  project.part = part_of(project.references, stage ? *stage : StageJob());
  const fs::path& folder = options.survey.files.working_folder;
  project.fingerprint =
      fingerprint(project, options.matching, kept_contents(folder, options.job), context);
  return project;
}

ExistingMaps checked_maps(Project& project, const MatchOptions& options, bool for_tile,
                          const Context& context) {
  ExistingMaps existing = find_existing_maps(project, options.make_maps, context);
  if (!options.make_maps)
    keep_images_with_maps(project, existing, context);
  else if (for_tile)
    require_final_maps(project, options, existing);
  else
    check_overwriting(project, options.overwrite_dmaps, existing, context);
  return existing;
}

// Runs that make parts of the maps or read complete maps can share a folder. A run that makes all
// maps removes those of earlier stages, which another run would miss.
LockUse use_of_maps(const Project& project, const Options& options, const ExistingMaps& existing) {
  const auto* stage = options.job_as<StageJob>();
  const bool shared = existing.are_final || (stage && stage->parts > 0) ||
                      are_complete(project, options.matching, existing);
  return shared ? LockUse::shared : LockUse::alone;
}

// Runs for a part, a stage or a list do not write the output itself.
LockUse use_of_output(const Options& options) {
  const bool alone = options.job_as<WholeRun>() || options.job_as<ExportJob>();
  return alone ? LockUse::alone : LockUse::shared;
}

// The images of the part that this run makes, and their sources.
std::vector<std::size_t> images_of_part(const Project& project) {
  std::set<std::size_t> images(project.part.begin(), project.part.end());
  for (const std::size_t image : project.part)
    for (const ViewScore& source : project.sources[image]) images.insert(source.image);
  return {images.begin(), images.end()};
}

void remove_depth_maps(const Project& project) {
  for (const std::size_t image : project.references)
    for (const fs::path& file : io::with_side_file(depth_map_path(project, image)))
      fs::remove(file);
}

// A run that makes or uses depth maps, after all checks and before the first map is made.
struct MapRun {
  const Options& options;
  const Context& context;
  Project project;
  ExistingMaps existing;
  OutputLock lock;
  MemoryPlan plan;

  MapRun(const Options& of_run, const RunFiles& files, const SceneObserver& observer,
         const Context& of_caller)
      : options(of_run),
        context(of_caller),
        project(load_with_fingerprint(options, observer, context)),
        existing(
            checked_maps(project, options.matching, options.job_as<TileJob>() != nullptr, context)),
        lock(options.survey.files.working_folder / "depth_maps",
             use_of_maps(project, options, existing)),
        plan(plan_memory(project, options, context)) {
    check_outputs(project, files, options.matching.pictures);
    if (const fs::path& folder = options.output.pinhole_export; !folder.empty())
      check_pinhole_export(project, folder);
  }

  survey::ImageStore images() const {
    const bool colors = options.fusion.needs_colors();
    return {project, colors ? survey::Channels::both : survey::Channels::grey, plan.cached_images};
  }

  // Makes or uses the depth maps of the run's images.
  void prepare_maps(survey::ImageStore& images) const {
    const auto* job = options.job_as<StageJob>();
    // The first stage reads the images of its part. Later stages need not check them again.
    if (!job || job->parts == 0)
      images.check_all(plan.decodes, context);
    else if (stages_until(job->until, options.matching) == 1)
      images.check(images_of_part(project), plan.decodes, context);
    const fs::path& report = options.output.report;
    if (options.matching.make_maps)
      return make_depth_maps({project, existing, plan, images, context}, options.matching, job,
                             report);
    const auto read_map = [&](std::size_t image) {
      return read_final_map(project, existing, image, images.mask(image), context);
    };
    check_agreement(project, plan, false, read_map, report, context);
  }
};

// Makes what a job asks for.
struct JobRun {
  const Options& options;
  const SceneObserver& observer;
  const Context& context;
  const RunFiles files;

  Report operator()(const ExportJob& job) const {
    const fs::path& points = options.views.point_cloud;
    const WrittenCloud cloud =
        export_cloud(load_scene(options.survey, points, options.output.scene, true, context), job,
                     options.output, files.inputs, context);
    return {Result::point_export, cloud.file, cloud.points};
  }

  Report operator()(const NeighbourListsJob& job) const {
    const Project project =
        load_project(options.survey, options.views, options.output.scene, observer, context);
    check_outputs(project, files, options.matching.pictures);
    write_neighbour_lists(job.file, project.scene);
    return {Result::neighbour_lists, {}};
  }

  Report operator()(const PlanJob& job) const {
    const Project project = load_with_fingerprint(options, observer, context);
    check_outputs(project, files, options.matching.pictures);
    write_work_plan(project, options, job, context);
    return {Result::plan, {}};
  }

  Report operator()(const StageJob&) const {
    const MapRun run(options, files, observer, context);
    survey::ImageStore images = run.images();
    run.prepare_maps(images);
    return {Result::stage, {}, 0, run.project.part.size()};
  }

  // Depth maps and images were checked when the maps were made.
  Report operator()(const TileJob& job) const {
    const MapRun run(options, files, observer, context);
    survey::ImageStore images = run.images();
    const std::size_t points = write_tile({run.project, run.existing, run.plan, images, context},
                                          options.fusion, options.output, job.tile);
    return {Result::tile, tile_file(options.output.scene, job.tile, options.fusion.tiles, ".ply"),
            points, run.project.references.size(), true};
  }

  Report operator()(const WholeRun&) const {
    const bool fuse = options.fusion.fuse;
    MapRun run(options, files, observer, context);
    const fs::path ply = fs::path(options.output.scene).replace_extension(".ply");
    const std::size_t points = make_cloud(run, ply);
    write_scene(run.project);
    context.info("{}: {} points", ply.string(), points);
    if (fuse && points == 0)
      context.warning(
          "The cloud is empty: no point was seen by {} views (see {}), or masks and the region of "
          "interest exclude all points",
          options.fusion.min_views, setting("fusion.min_views"));
    if (!options.output.pinhole_export.empty())
      export_pinholes(run.project, options.output, run.existing, run.plan.exports, context);
    if (fuse) remove_tiles(options.output.scene, options.fusion.tiles, context);
    if (fuse && options.fusion.remove_dmaps) remove_depth_maps(run.project);
    return {fuse ? Result::dense_cloud : Result::sparse_cloud, ply, points,
            run.project.references.size(), all_pinholes(run.project)};
  }

 private:
  // The images are in memory only in this function. If the maps are not fused, the sparse cloud
  // gets the dense cloud's name, as in OpenMVS.
  std::size_t make_cloud(const MapRun& run, const fs::path& ply) const {
    const Project& project = run.project;
    survey::ImageStore images = run.images();
    run.prepare_maps(images);
    pass_maps(run, images);
    if (options.fusion.fuse)
      return write_cloud({project, run.existing, run.plan, images, context}, options.fusion,
                         options.output);
    io::write_cloud_ply(ply, cloud_of(project.scene), true,
                        {project.frame, options.output.double_precision});
    return project.scene.points.size();
  }

  void pass_maps(const MapRun& run, survey::ImageStore& images) const {
    if (!options.output.take_map) return;
    for (const std::size_t image : run.project.references) {
      const cv::Mat1b mask = run.existing.are_final ? images.mask(image) : cv::Mat1b();
      DepthMap map = read_final_map(run.project, run.existing, image, mask, context);
      map.image_path = run.project.scene.images[image].path;
      options.output.take_map(image, std::move(map));
    }
  }

  void write_scene(const Project& project) const {
    return_freed_memory();  // the images' memory is needed to write the scene
    const io::SceneFiles& from = options.survey.files;
    io::write_cameras_beside(options.output.scene, project, project.lenses, from, context);
    io::write_mvs(options.output.scene, project.scene, from.working_folder);
  }
};

}  // namespace

Report densify(const Options& options, const SceneObserver& observer, const Context& context) {
  if (!context.memory().is_limited())
    return densify(options, observer, Context(context, MemoryBudget::of_program(0)));
  check(options);
  // If its folder cannot be made, require_writable reports it.
  const OutputLock lock = lock_output(options.output.scene, use_of_output(options));
  const JobRun run{options, observer, context, files_of(options)};
  check_outputs(run.files, options.survey.files);
  return std::visit(run, options.job);
}

}  // namespace axial::densify
