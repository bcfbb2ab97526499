// SPDX-License-Identifier: GPL-3.0-or-later
#include "fusion_stage.h"

#include <spdlog/spdlog.h>

#include "base/progress.h"
#include "cloud/colors.h"
#include "cloud/crop.h"
#include "cloud/fuse.h"
#include "cloud/normals.h"
#include "depth_stage.h"
#include "io/dmap.h"

namespace densify {

axial::PointCloud make_cloud(const Project& project, const Options& options) {
  std::vector<axial::cloud::FusionView> views;
  for (const std::size_t image : project.references) {
    axial::cloud::FusionView view{static_cast<std::uint32_t>(image), {}, 0};
    for (const axial::ViewScore& neighbour : project.neighbours[image])
      view.neighbours.push_back(neighbour.image);
    view.rank = project.scene.images[image].neighbours.size();
    views.push_back(view);
  }
  const auto color = [&](std::size_t image) { return load_color(project, image); };
  axial::cloud::FusionProviders providers;
  providers.load_map = [&](std::size_t image) {
    return axial::io::read_dmap(depth_map_path(project, options, image)).map;
  };
  if (options.estimate_colors == 2) providers.load_color = color;

  axial::PointCloud cloud = axial::cloud::fuse(project.scene, views, providers, options.fusion,
                                               axial::console_progress("Fused depth maps"));
  if (options.crop_to_roi && project.scene.region) {
    const std::size_t removed = axial::cloud::crop(cloud, *project.scene.region);
    spdlog::info("Region of interest: {} points outside removed", removed);
  }
  if (options.estimate_colors == 1 && cloud.size() > 0)
    axial::cloud::estimate_colors(cloud, project.scene, color);
  if (options.estimate_normals == 1 && cloud.size() > 0)
    axial::cloud::estimate_normals(cloud, project.scene);
  return cloud;
}

}  // namespace densify
