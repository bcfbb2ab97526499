// SPDX-License-Identifier: GPL-3.0-or-later
#include "fusion_stage.h"

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "base/memory.h"
#include "base/progress.h"
#include "cloud/colors.h"
#include "cloud/crop.h"
#include "cloud/fuse.h"
#include "cloud/normals.h"
#include "io/json.h"
#include "io/ply.h"

namespace densify {
namespace {

std::vector<axial::cloud::FusionView> views_to_fuse(const Project& project) {
  std::vector<axial::cloud::FusionView> views;
  for (const std::size_t image : project.references) {
    axial::cloud::FusionView view{static_cast<std::uint32_t>(image), {}, 0};
    for (const axial::ViewScore& neighbour : project.neighbours[image])
      view.neighbours.push_back(neighbour.image);
    view.rank = project.scene.images[image].neighbours.size();
    views.push_back(view);
  }
  return views;
}

class CloudRun {
 public:
  CloudRun(const Project& project, const Options& options, const MemoryPlan& plan,
           const ExistingMaps& existing, ImageStore& images, const std::filesystem::path& ply)
      : project_(project),
        options_(options),
        plan_(plan),
        existing_(existing),
        images_(images),
        ply_(ply) {}

  std::size_t run() {
    const bool whole = options_.estimate_colors == 1 || options_.estimate_normals == 1;
    const std::size_t points = whole ? run_in_memory() : run_in_a_stream();
    if (removed_ > 0) axial::log_info("Region of interest: {} points outside removed", removed_);
    report(points);
    return points;
  }

 private:
  std::size_t run_in_a_stream() {
    axial::io::CloudWriter writer(ply_,
                                  {options_.estimate_colors == 2, options_.estimate_normals == 2,
                                   true, true, options_.fusion.errors},
                                  placement_of(project_, options_));
    fuse_into([&](const axial::PointCloud& portion) { writer.add(portion); });
    writer.finish();
    return writer.size();
  }

  std::size_t run_in_memory() {
    axial::PointCloud cloud;
    cloud.view_begin.push_back(0);
    fuse_into([&](const axial::PointCloud& portion) { axial::cloud::append(cloud, portion); });
    if (options_.estimate_colors == 1)
      axial::cloud::estimate_colors(cloud, project_.scene,
                                    [&](std::size_t image) { return images_.get(image)->color; });
    if (options_.estimate_normals == 1) axial::cloud::estimate_normals(cloud, project_.scene);
    axial::io::write_cloud_ply(ply_, cloud, true, placement_of(project_, options_));
    return cloud.size();
  }

  axial::DepthMap load_map(std::size_t image) const {
    // A map without normals stays so: fusion estimates them.
    const cv::Mat1b mask = options_.make_maps ? cv::Mat1b() : images_.mask(image);
    return read_final_map(project_, options_, existing_, image, mask);
  }

  void fuse_into(const axial::cloud::CloudSink& sink) {
    axial::cloud::FusionProviders providers;
    providers.load_map = [&](std::size_t image) { return load_map(image); };
    if (options_.estimate_colors == 2)
      providers.load_color = [&](std::size_t image) { return images_.get(image)->color; };
    axial::cloud::FuseOptions fusion = options_.fusion;
    fusion.max_maps = plan_.fused_maps;
    fusion.max_loads = plan_.fusion_loads;
    axial::cloud::fuse(
        project_.scene, views_to_fuse(project_), providers, fusion,
        [&](axial::PointCloud portion) {
          if (options_.crop_to_roi && project_.scene.region)
            removed_ += axial::cloud::crop(portion, *project_.scene.region);
          count_points_of_two(portion);
          sink(std::move(portion));
        },
        axial::console_progress("Fused depth maps"));
  }

  void count_points_of_two(const axial::PointCloud& portion) {
    for (std::size_t i = 0; i < portion.size(); ++i)
      if (portion.view_begin[i + 1] - portion.view_begin[i] == 2) ++of_two_;
  }

  void report(std::size_t points) const {
    if (of_two_ > 0)
      axial::log_info("{} points ({:.1f} %) are supported by only two depth maps", of_two_,
                      100.0 * static_cast<double>(of_two_) / static_cast<double>(points));
    if (options_.report.empty()) return;
    nlohmann::json report = axial::io::read_json(options_.report);
    report["fusion"] = {{"points", points}, {"of_two_maps", of_two_}};
    axial::io::write_json(options_.report, report);
  }

  const Project& project_;
  const Options& options_;
  const MemoryPlan& plan_;
  const ExistingMaps& existing_;
  ImageStore& images_;
  const std::filesystem::path& ply_;
  std::size_t removed_ = 0;
  std::size_t of_two_ = 0;
};

}  // namespace

axial::io::PlyPlacement placement_of(const Project& project, const Options& options) {
  return {project.frame, options.double_precision};
}

std::size_t write_cloud(const Project& project, const Options& options, const MemoryPlan& plan,
                        const ExistingMaps& existing, ImageStore& images,
                        const std::filesystem::path& ply) {
  axial::map_large_blocks();
  return CloudRun(project, options, plan, existing, images, ply).run();
}

}  // namespace densify
