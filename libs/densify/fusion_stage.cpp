// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/fusion_stage.h"

#include <system_error>

#include "base/memory.h"
#include "cloud/colors.h"
#include "cloud/normals.h"
#include "densify/fusion_run.h"
#include "densify/tile_files.h"
#include "densify/tile_stage.h"
#include "io/ply/ply.h"

namespace axial::densify {
namespace {

CloudCounts fuse_whole(const FusionRun& run, const cloud::CloudSink& sink) {
  return fuse_maps(run, views_to_fuse(run.project), {}, run.plan.fused_maps, "Fused depth maps",
                   sink);
}

CloudCounts write_in_a_stream(const FusionRun& run, const std::filesystem::path& ply) {
  io::CloudWriter writer(ply, layout_of(run.settings), placement_of(run.project, run.settings));
  const CloudCounts counts =
      fuse_whole(run, [&](const PointCloud& portion) { writer.add(portion); });
  writer.finish();
  return counts;
}

CloudCounts write_from_memory(const FusionRun& run, const std::filesystem::path& ply) {
  const Scene& scene = run.project.scene;
  PointCloud cloud;
  cloud.view_begin.push_back(0);
  const CloudCounts counts =
      fuse_whole(run, [&](const PointCloud& portion) { cloud::append(cloud, portion); });
  if (run.settings.estimate_colors == 1)
    cloud::estimate_colors(cloud, scene,
                           [&](std::size_t image) { return run.images.get(image)->color; });
  if (run.settings.estimate_normals == 1) cloud::estimate_normals(cloud, scene);
  io::write_cloud_ply(ply, cloud, true, placement_of(run.project, run.settings));
  return counts;
}

}  // namespace

io::PlyPlacement placement_of(const Project& project, const Settings& settings) {
  return {project.frame, settings.double_precision};
}

std::size_t write_cloud(const Project& project, const Settings& settings, const MemoryPlan& plan,
                        const ExistingMaps& existing, survey::ImageStore& images,
                        const std::filesystem::path& ply) {
  map_large_blocks();
  const FusionRun run{project, settings, plan, existing, images};
  std::error_code ignored;
  const bool tiled =
      settings.fusion_tiles > 1 || std::filesystem::exists(tile_file(settings, 1), ignored);
  const bool whole = settings.estimate_colors == 1 || settings.estimate_normals == 1;
  const CloudCounts counts = whole   ? write_from_memory(run, ply)
                             : tiled ? write_tiles(run, ply)
                                     : write_in_a_stream(run, ply);
  report_counts(settings, counts);
  return counts.points;
}

}  // namespace axial::densify
