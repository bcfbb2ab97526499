// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/fusion_stage.h"

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "base/memory.h"
#include "base/progress.h"
#include "cloud/colors.h"
#include "cloud/crop.h"
#include "cloud/fuse.h"
#include "cloud/normals.h"
#include "io/bytes/json.h"
#include "io/ply/ply.h"

namespace axial::densify {
namespace {

std::vector<cloud::FusionView> views_to_fuse(const Project& project) {
  std::vector<cloud::FusionView> views;
  for (const std::size_t image : project.references) {
    cloud::FusionView view{static_cast<std::uint32_t>(image), {}, 0};
    for (const ViewScore& neighbour : project.neighbours[image])
      view.neighbours.push_back(neighbour.image);
    view.rank = project.scene.images[image].neighbours.size();
    views.push_back(view);
  }
  return views;
}

class CloudRun {
 public:
  CloudRun(const Project& project, const Settings& settings, const MemoryPlan& plan,
           const ExistingMaps& existing, ImageStore& images, const std::filesystem::path& ply)
      : project_(project),
        settings_(settings),
        plan_(plan),
        existing_(existing),
        images_(images),
        ply_(ply) {}

  std::size_t run() {
    const bool whole = settings_.estimate_colors == 1 || settings_.estimate_normals == 1;
    const std::size_t points = whole ? run_in_memory() : run_in_a_stream();
    if (removed_ > 0) log_info("Region of interest: {} points outside removed", removed_);
    report(points);
    return points;
  }

 private:
  std::size_t run_in_a_stream() {
    io::CloudWriter writer(ply_,
                           {settings_.estimate_colors == 2, settings_.estimate_normals == 2, true,
                            true, settings_.fusion.errors},
                           placement_of(project_, settings_));
    fuse_into([&](const PointCloud& portion) { writer.add(portion); });
    writer.finish();
    return writer.size();
  }

  std::size_t run_in_memory() {
    PointCloud cloud;
    cloud.view_begin.push_back(0);
    fuse_into([&](const PointCloud& portion) { cloud::append(cloud, portion); });
    if (settings_.estimate_colors == 1)
      cloud::estimate_colors(cloud, project_.scene,
                             [&](std::size_t image) { return images_.get(image)->color; });
    if (settings_.estimate_normals == 1) cloud::estimate_normals(cloud, project_.scene);
    io::write_cloud_ply(ply_, cloud, true, placement_of(project_, settings_));
    return cloud.size();
  }

  DepthMap load_map(std::size_t image) const {
    // A map without normals stays so: fusion estimates them.
    const cv::Mat1b mask = settings_.make_maps ? cv::Mat1b() : images_.mask(image);
    return read_final_map(project_, settings_, existing_, image, mask);
  }

  void fuse_into(const cloud::CloudSink& sink) {
    cloud::FusionProviders providers;
    providers.load_map = [&](std::size_t image) { return load_map(image); };
    if (settings_.estimate_colors == 2)
      providers.load_color = [&](std::size_t image) { return images_.get(image)->color; };
    cloud::FuseOptions fusion = settings_.fusion;
    fusion.normals = settings_.estimate_normals == 2;
    fusion.max_maps = plan_.fused_maps;
    fusion.max_loads = plan_.fusion_loads;
    cloud::fuse(
        project_.scene, views_to_fuse(project_), providers, fusion,
        [&](PointCloud portion) {
          if (settings_.crop_to_roi && project_.scene.region)
            removed_ += cloud::crop(portion, *project_.scene.region);
          count_points_of_two(portion);
          sink(std::move(portion));
        },
        console_progress("Fused depth maps"));
  }

  void count_points_of_two(const PointCloud& portion) {
    for (std::size_t i = 0; i < portion.size(); ++i)
      if (portion.view_begin[i + 1] - portion.view_begin[i] == 2) ++of_two_;
  }

  void report(std::size_t points) const {
    if (of_two_ > 0)
      log_info("{} points ({:.1f} %) are supported by only two depth maps", of_two_,
               100.0 * static_cast<double>(of_two_) / static_cast<double>(points));
    if (settings_.report.empty()) return;
    nlohmann::json report = io::read_json(settings_.report);
    report["fusion"] = {{"points", points}, {"of_two_maps", of_two_}};
    io::write_json(settings_.report, report);
  }

  const Project& project_;
  const Settings& settings_;
  const MemoryPlan& plan_;
  const ExistingMaps& existing_;
  ImageStore& images_;
  const std::filesystem::path& ply_;
  std::size_t removed_ = 0;
  std::size_t of_two_ = 0;
};

}  // namespace

io::PlyPlacement placement_of(const Project& project, const Settings& settings) {
  return {project.frame, settings.double_precision};
}

std::size_t write_cloud(const Project& project, const Settings& settings, const MemoryPlan& plan,
                        const ExistingMaps& existing, ImageStore& images,
                        const std::filesystem::path& ply) {
  map_large_blocks();
  return CloudRun(project, settings, plan, existing, images, ply).run();
}

}  // namespace axial::densify
