// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/fusion_run.h"

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "base/progress.h"
#include "cloud/crop.h"
#include "io/bytes/json.h"

namespace axial::densify {
namespace {

std::size_t points_of_two(const PointCloud& portion) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < portion.size(); ++i)
    if (portion.view_begin[i + 1] - portion.view_begin[i] == 2) ++count;
  return count;
}

cloud::FusionProviders providers_of(const FusionRun& run) {
  cloud::FusionProviders providers;
  providers.load_map = [&run](std::size_t image) { return load_final_map(run, image); };
  if (run.settings.estimate_colors == 2)
    providers.load_color = [&run](std::size_t image) { return run.images.get(image)->color; };
  return providers;
}

}  // namespace

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

DepthMap load_final_map(const FusionRun& run, std::size_t image) {
  const cv::Mat1b mask = run.settings.make_maps ? cv::Mat1b() : run.images.mask(image);
  return read_final_map(run.project, run.settings, run.existing, image, mask);
}

CloudCounts fuse_maps(const FusionRun& run, const std::vector<cloud::FusionView>& views,
                      const std::optional<cloud::FusionPart>& part, std::size_t max_maps,
                      const std::string& title, const cloud::CloudSink& sink) {
  const Scene& scene = run.project.scene;
  cloud::FuseOptions options = run.settings.fusion;
  options.normals = run.settings.estimate_normals == 2;
  options.max_maps = max_maps;
  options.max_loads = run.plan.fusion_loads;
  options.part = part;
  CloudCounts counts;
  cloud::fuse(
      scene, views, providers_of(run), options,
      [&](PointCloud portion) {
        if (run.settings.crop_to_roi && scene.region)
          counts.removed += cloud::crop(portion, *scene.region);
        counts.points += portion.size();
        counts.of_two += points_of_two(portion);
        sink(std::move(portion));
      },
      console_progress(title));
  return counts;
}

io::CloudLayout layout_of(const Settings& settings) {
  return {settings.estimate_colors == 2, settings.estimate_normals == 2, true, true,
          settings.fusion.errors};
}

void report_counts(const Settings& settings, const CloudCounts& counts) {
  if (counts.removed > 0) log_info("Region of interest: {} points outside removed", counts.removed);
  if (counts.of_two > 0)
    log_info("{} points ({:.1f} %) are supported by only two depth maps", counts.of_two,
             100.0 * static_cast<double>(counts.of_two) / static_cast<double>(counts.points));
  if (settings.report.empty()) return;
  nlohmann::json report = io::read_json(settings.report);
  report["fusion"] = {{"points", counts.points}, {"of_two_maps", counts.of_two}};
  io::write_json(settings.report, report);
}

}  // namespace axial::densify
