// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "agreement_check.h"
#include "base/atomic_file.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "cloud_exports.h"
#include "depth_stage.h"
#include "existing_maps.h"
#include "fusion_stage.h"
#include "image_store.h"
#include "io/openmvs/mvs.h"
#include "io/ply/ply.h"
#include "memory_plan.h"
#include "neighbour_lists.h"
#include "options.h"
#include "outputs.h"
#include "pinhole_export.h"
#include "pinhole_folder.h"
#include "project.h"

namespace {

namespace fs = std::filesystem;

// With --fusion-mode 1 the sparse cloud gets the dense cloud's name, as in OpenMVS.
std::size_t write_sparse_cloud(const densify::Project& project, const densify::Options& options,
                               const fs::path& ply) {
  axial::io::write_cloud_ply(ply, densify::cloud_of(project.scene), true,
                             densify::placement_of(project, options));
  return project.scene.points.size();
}

void remove_depth_maps(const densify::Project& project, const densify::Options& options) {
  for (const std::size_t image : project.references) {
    const fs::path file = densify::depth_map_path(project, options, image);
    fs::remove(file);
    fs::remove(file.string() + ".json");
  }
}

// As in OpenMVS. If the folder cannot be made, require_writable reports it.
void make_folder_of(const fs::path& file) {
  std::error_code ignored;
  fs::create_directories(file.parent_path(), ignored);
}

// OpenMVS's programs do not know ports or distortion, and report no error for scenes that have
// them.
void say_who_may_read(const densify::Project& project, const densify::Options& options) {
  if (densify::all_pinholes(project)) return;
  const fs::path name = options.output.filename();
  const std::string folder =
      options.pinhole_export.empty() ? "DIR" : options.pinhole_export.filename().string();
  axial::log_info(
      "{} has cameras behind ports or with distorted lenses, which OpenMVS treats as pinholes: its "
      "ReconstructMesh can use {} and the cloud, but RefineMesh, TextureMesh and fusion of the "
      "depth maps give wrong results; --pinhole-export {} writes files that all of OpenMVS's "
      "programs can use",
      name.string(), name.string(), folder);
}

void check_existing_maps(const densify::Project& project, const densify::Options& options,
                         const densify::MemoryPlan& plan, const densify::ExistingMaps& existing,
                         densify::ImageStore& images) {
  densify::check_agreement(project, options, plan, false, [&](std::size_t image) {
    return densify::read_final_map(project, options, existing, image, images.mask(image));
  });
}

int run(int argc, char** argv) {
  const densify::Options options = densify::parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  axial::share_one_heap();
  const axial::ThreadLimit threads(options.parsed.common.max_threads);

  make_folder_of(options.output);
  densify::check_outputs(options);
  if (densify::only_exports(options)) {
    densify::export_cloud(densify::load_scene(options), options);
    return 0;
  }
  if (!options.neighbour_lists_output.empty()) {
    const densify::Project project = densify::load_project(options);
    densify::check_outputs(project, options);
    densify::write_neighbour_lists(options.neighbour_lists_output, project.scene);
    return 0;
  }
  densify::Project loaded = densify::load_project(options);
  const densify::ExistingMaps existing = densify::find_existing_maps(loaded, options);
  if (options.make_maps)
    densify::check_overwriting(loaded, options, existing);
  else
    densify::keep_images_with_maps(loaded, options, existing);
  const densify::Project& project = loaded;
  const densify::MemoryPlan plan = densify::plan_memory(project, options);
  densify::check_outputs(project, options);
  densify::check_pinhole_export(project, options);
  std::optional<densify::ImageStore> images(std::in_place, project, options, plan.cached_images);
  images->check_all(plan.decodes);
  if (options.make_maps)
    densify::make_depth_maps(project, options, plan, existing, *images);
  else
    check_existing_maps(project, options, plan, existing, *images);

  fs::path ply = options.output;
  ply.replace_extension(".ply");
  const std::size_t points =
      options.fuse ? densify::write_cloud(project, options, plan, existing, *images, ply)
                   : write_sparse_cloud(project, options, ply);
  images.reset();  // its memory is needed to write the scene
  axial::return_freed_memory();
  densify::write_cameras_beside_output(project, options);
  axial::io::write_mvs(options.output, project.scene, options.parsed.common.working_folder);
  axial::log_info("{}: {} points", ply.string(), points);
  if (options.fuse && points == 0)
    axial::log_warning(
        "The cloud is empty: no point was seen by {} views (see --number-views-fuse), or masks and "
        "the region of interest exclude all points",
        options.fusion.min_views);
  densify::export_pinholes(loaded, options, plan, existing, ply);
  if (options.remove_dmaps && options.fuse) remove_depth_maps(project, options);
  say_who_may_read(project, options);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return axial::run_program("DensifyPointCloud", [&] { return run(argc, argv); });
}
