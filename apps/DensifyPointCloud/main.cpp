// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "depth_stage.h"
#include "fusion_stage.h"
#include "image_store.h"
#include "io/mvs.h"
#include "io/ply.h"
#include "memory_plan.h"
#include "options.h"
#include "project.h"

namespace {

namespace fs = std::filesystem;

// --fusion-mode 1 leaves the sparse cloud under the dense one's name, as OpenMVS does.
std::size_t write_sparse_cloud(const densify::Project& project, const densify::Options& options,
                               const fs::path& ply) {
  const axial::Scene& scene = project.scene;
  axial::PointCloud cloud;
  cloud.view_begin.push_back(0);
  for (const axial::SparsePoint& point : scene.points) {
    cloud.positions.push_back(point.position);
    for (const axial::SparseView& view : point.views) {
      cloud.view_images.push_back(view.image);
      cloud.view_weights.push_back(view.confidence);
    }
    cloud.view_begin.push_back(cloud.view_images.size());
  }
  cloud.normals = scene.point_normals;
  cloud.colors = scene.point_colors;
  axial::io::write_cloud_ply(ply, cloud, true, densify::placement_of(project, options));
  return cloud.size();
}

void remove_depth_maps(const densify::Project& project, const densify::Options& options) {
  for (const std::size_t image : project.references) {
    const fs::path file = densify::depth_map_path(project, options, image);
    fs::remove(file);
    fs::remove(file.string() + ".json");
  }
}

int run(int argc, char** argv) {
  const densify::Options options = densify::parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  axial::share_one_heap();
  const axial::ThreadLimit threads(options.parsed.common.max_threads);

  axial::require_writable(options.output);
  axial::require_writable(options.parsed.common.working_folder / "depth0000.dmap");
  axial::remove_abandoned(options.parsed.common.working_folder, "depth");
  const densify::Project project = densify::load_project(options);
  const densify::MemoryPlan plan = densify::plan_memory(project, options);
  densify::ImageStore images(project, options, plan.cached_images);
  images.check_all(plan.decodes);
  densify::make_depth_maps(project, options, plan, images);

  fs::path ply = options.output;
  ply.replace_extension(".ply");
  const std::size_t points = options.fuse
                                 ? densify::write_cloud(project, options, plan, images, ply)
                                 : write_sparse_cloud(project, options, ply);
  densify::write_cameras_beside_output(project, options);
  axial::io::write_mvs(options.output, project.scene, options.parsed.common.working_folder);
  axial::log_info("{}: {} points", ply.string(), points);
  if (options.fuse && points == 0)
    axial::log_warning(
        "The cloud is empty: no point was seen by {} views (see --number-views-fuse), or "
        "masks and the region of interest leave nothing",
        options.fusion.min_views);
  if (options.remove_dmaps && options.fuse) remove_depth_maps(project, options);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return axial::run_program("DensifyPointCloud", [&] { return run(argc, argv); });
}
