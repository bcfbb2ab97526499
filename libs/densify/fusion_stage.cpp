// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/fusion_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/program/tiling.h"
#include "cloud/colors.h"
#include "cloud/crop.h"
#include "cloud/normals.h"
#include "io/bytes/json.h"
#include "io/ply/ply.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

std::size_t points_of_two(const PointCloud& portion) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < portion.size(); ++i)
    if (portion.view_begin[i + 1] - portion.view_begin[i] == 2) ++count;
  return count;
}

// The arguments that all parts share. The referenced objects must outlive it.
struct FusionRun : Run {
  const FusionOptions& options;
  const OutputOptions& output;

  fs::path ply() const { return fs::path(output.scene).replace_extension(".ply"); }
  fs::path tile(std::size_t tile) const {
    return tile_file(output.scene, tile, options.tiles, ".ply");
  }
  io::PlyPlacement placement() const { return {project.frame, output.double_precision}; }

  // A writer of clouds whose colours and normals are not estimated from the whole cloud.
  io::CloudWriter writer(const fs::path& file) const {
    return {
        file,
        {options.estimate_colors == 2, options.estimate_normals == 2, true, true, options.errors},
        placement()};
  }
};

// Reads the final map of an image. A map without normals stays so: fusion estimates them.
DepthMap load_final_map(const FusionRun& run, std::size_t image) {
  const cv::Mat1b mask = run.existing.are_final ? run.images.mask(image) : cv::Mat1b();
  return read_final_map(run.project, run.existing, image, mask, run.context);
}

cloud::FusionProviders providers_of(const FusionRun& run) {
  cloud::FusionProviders providers;
  providers.load_map = [&run](std::size_t image) { return load_final_map(run, image); };
  if (run.options.estimate_colors == 2)
    providers.load_color = [&run](std::size_t image) { return run.images.get(image)->color; };
  return providers;
}

// Fuses `views`. Points outside the region of interest are left out if the options ask for it.
// `part`: empty for the whole cloud. `max_maps`: FuseOptions::max_maps. `title`: shown with the
// progress. Passes the points to `sink` and returns their numbers.
CloudCounts fuse_maps(const FusionRun& run, const std::vector<cloud::FusionView>& views,
                      const std::optional<cloud::FusionPart>& part, std::size_t max_maps,
                      const std::string& title, const cloud::CloudSink& sink) {
  const Scene& scene = run.project.scene;
  cloud::FuseOptions options = run.options;
  options.normals = run.options.estimate_normals == 2;
  options.max_maps = max_maps;
  options.max_loads = run.plan.fusion_loads;
  options.part = part;
  CloudCounts counts;
  cloud::fuse(
      scene, views, providers_of(run), options,
      [&](PointCloud portion) {
        if (run.options.crop_to_roi && scene.region)
          counts.removed += cloud::crop(portion, *scene.region);
        counts.points += portion.size();
        counts.of_two += points_of_two(portion);
        sink(std::move(portion));
      },
      run.context.stage(title));
  return counts;
}

// Logs the numbers of points outside the region and of points of two maps, and adds an entry
// "fusion" to the file `report` unless the path is empty.
void report_counts(const fs::path& file, const CloudCounts& counts, const Context& context) {
  if (counts.removed > 0)
    context.info("Region of interest: {} points outside removed", counts.removed);
  if (counts.of_two > 0)
    context.info("{} points ({:.1f} %) are supported by only two depth maps", counts.of_two,
                 100.0 * static_cast<double>(counts.of_two) / static_cast<double>(counts.points));
  if (file.empty()) return;
  nlohmann::json report = io::read_json(file);
  report["fusion"] = {{"points", counts.points}, {"of_two_maps", counts.of_two}};
  io::write_json(file, report);
}

void add_box(Fingerprint& print, const cloud::Tile& box) {
  for (const double value : box.rotation.reshaped()) print.add(value);
  for (const double value : box.low) print.add(value);
  for (const double value : box.high) print.add(value);
}

// Everything besides the depth maps and the tile on which the points depend.
void add_options(Fingerprint& print, const FusionRun& run) {
  const FusionOptions& options = run.options;
  // Normals are a setting of their own, and the part is added for each tile. The last two do not
  // change the points. A new member does not compile until it has a name here.
  const auto& [min_views, two_if_undisputed, depth_threshold, normal_threshold, normals, errors,
               part, max_maps, max_loads] = static_cast<const cloud::FuseOptions&>(options);
  for (const std::uint64_t value :
       {std::uint64_t{min_views}, std::uint64_t{two_if_undisputed}, std::uint64_t{errors},
        std::uint64_t{options.estimate_colors}, std::uint64_t{options.estimate_normals},
        std::uint64_t{run.output.double_precision}})
    print.add(value);
  print.add(depth_threshold).add(normal_threshold);
  for (const double value : run.project.frame.origin) print.add(value);
  const auto& region = run.project.scene.region;
  print.add(std::uint64_t{options.crop_to_roi && region});
  if (!options.crop_to_roi || !region) return;
  for (const double value : region->rotation.reshaped()) print.add(value);
  for (const double value : region->centre) print.add(value);
  for (const double value : region->half_extent) print.add(value);
}

class TileRun {
 public:
  explicit TileRun(const FusionRun& run)
      : run_(run),
        views_(views_to_fuse(run.project)),
        parts_(tiles_of(run.project, run.options)),
        contents_(views_.size()) {
    look_at_maps();
  }

  // Makes the tile (from 1) unless its file is there already.
  CloudCounts make(std::size_t tile) const {
    const io::Artifact cloud{run_.tile(tile), made_from(tile)};
    if (const auto counts = finished_tile(cloud)) {
      run_.context.info("{}: exists already, {} points", cloud.file.string(), counts->points);
      return *counts;
    }
    io::remove_with_side_file(cloud.file);
    const CloudCounts counts = fuse(tile, cloud.file);
    finish_tile(cloud, counts, parts_[tile - 1].tile);
    return counts;
  }

  // Error if a tile needs more memory than the plan has.
  void require_memory() const {
    for (std::size_t tile = 1; tile <= parts_.size(); ++tile) most_maps(tile);
  }

 private:
  // Finds the views that see each tile, and fingerprints of the maps.
  void look_at_maps() {
    std::vector<cloud::Tile> reaches;
    for (cloud::FusionPart& part : parts_) {
      reaches.push_back(part.reach);
      part.seen_by.assign(views_.size(), false);
    }
    std::vector<std::vector<bool>> seen(views_.size());  // for each view, one for each tile
    ProgressCounter counter(run_.context.stage("Assigned depth maps to tiles"), views_.size());
    for_each_in_flight(views_.size(), run_.plan.fusion_loads, [&](std::size_t view) {
      const DepthMap map = load_final_map(run_, views_[view].image);
      Fingerprint print;
      for (const cv::Mat& plane :
           {cv::Mat(map.depth), cv::Mat(map.normal), cv::Mat(map.confidence)})
        survey::add_pixels(print, plane);
      // The points of a tile may have colours, which the fingerprint of the maps does not hold.
      const auto& colors = run_.project.views[views_[view].image].colors;
      if (run_.options.needs_colors() && !colors.empty()) print.add(read_file(colors));
      seen[view] = cloud::boxes_seen(map, reaches);
      contents_[view] = print.hex();
      counter.add();
    });
    for (std::size_t view = 0; view < views_.size(); ++view)
      for (std::size_t i = 0; i < parts_.size(); ++i) parts_[i].seen_by[view] = seen[view][i];
  }

  std::string made_from(std::size_t tile) const {
    Fingerprint print;
    // The number is the version of the method of fusion.
    print.add("AxialMVS fusion tile 1").add(run_.project.fingerprint);
    add_options(print, run_);
    for (std::size_t i = 0; i < views_.size(); ++i)
      print.add(std::uint64_t{views_[i].image}).add(views_[i].rank).add(contents_[i]);
    print.add(std::uint64_t{tile}).add(std::uint64_t{parts_.size()});
    add_box(print, parts_[tile - 1].tile);
    add_box(print, parts_[tile - 1].reach);
    return print.hex();
  }

  // FuseOptions::max_maps for a tile, which marks the pixels of the views that it needs. The plan
  // has memory for an estimated number of views. If there are more, fewer maps are kept.
  std::size_t most_maps(std::size_t tile) const {
    const std::size_t needed = cloud::views_needed(views_, parts_[tile - 1]);
    // A map has at least 20 bytes a pixel, as much as the marks of 160 views.
    constexpr std::size_t kViewsPerMap = 160;
    const std::size_t planned = run_.plan.marked_views;
    const std::size_t fewer =
        needed > planned ? (needed - planned + kViewsPerMap - 1) / kViewsPerMap : 0;
    if (run_.plan.fused_maps < run_.plan.least_fused_maps + fewer)
      fail(
          "{} {}: tile {} of {} needs {} views, more than expected: allow more memory or use {} {}",
          setting("max_memory"), run_.context.memory().megabytes(), tile, parts_.size(), needed,
          setting("tiles"), 2 * parts_.size());
    return run_.plan.fused_maps - fewer;
  }

  CloudCounts fuse(std::size_t tile, const fs::path& ply) const {
    const cloud::FusionPart& part = parts_[tile - 1];
    const auto seen = std::ranges::count(part.seen_by, true);
    const std::size_t maps = most_maps(tile);
    const std::string title = fmt::format("Fused tile {} of {}", tile, parts_.size());
    io::CloudWriter writer = run_.writer(ply);
    const CloudCounts counts = fuse_maps(run_, views_, part, maps, title,
                                         [&](const PointCloud& portion) { writer.add(portion); });
    writer.finish();
    run_.context.info("Tile {} of {}: {} points, seen by {} of {} views", tile, parts_.size(),
                      counts.points, seen, views_.size());
    return counts;
  }

  const FusionRun& run_;
  std::vector<cloud::FusionView> views_;
  std::vector<cloud::FusionPart> parts_;
  std::vector<std::string> contents_;  // fingerprints of the maps of `views_`
};

CloudCounts write_tiles(const FusionRun& run) {
  const TileRun tiles(run);
  tiles.require_memory();
  io::CloudWriter writer = run.writer(run.ply());
  CloudCounts all;
  for (std::size_t tile = 1; tile <= run.options.tiles; ++tile) {
    const CloudCounts counts = tiles.make(tile);
    writer.add_file(run.tile(tile), counts.points);
    all.add(counts);
  }
  writer.finish();
  return all;
}

CloudCounts fuse_whole(const FusionRun& run, const cloud::CloudSink& sink) {
  return fuse_maps(run, views_to_fuse(run.project), {}, run.plan.fused_maps, "Fused depth maps",
                   sink);
}

CloudCounts write_in_a_stream(const FusionRun& run) {
  io::CloudWriter writer = run.writer(run.ply());
  const CloudCounts counts =
      fuse_whole(run, [&](const PointCloud& portion) { writer.add(portion); });
  writer.finish();
  return counts;
}

CloudCounts write_from_memory(const FusionRun& run) {
  const Scene& scene = run.project.scene;
  PointCloud cloud;
  cloud.view_begin.push_back(0);
  const CloudCounts counts =
      fuse_whole(run, [&](const PointCloud& portion) { cloud::append(cloud, portion); });
  if (run.options.estimate_colors == 1)
    cloud::estimate_colors(cloud, scene,
                           [&](std::size_t image) { return run.images.get(image)->color; });
  if (run.options.estimate_normals == 1) cloud::estimate_normals(cloud, scene);
  io::write_cloud_ply(run.ply(), cloud, true, run.placement());
  return counts;
}

}  // namespace

std::size_t write_cloud(const Run& run, const FusionOptions& options, const OutputOptions& output) {
  map_large_blocks();
  const FusionRun fusion{run, options, output};
  std::error_code ignored;
  const bool tiled = options.tiles > 1 || fs::exists(fusion.tile(1), ignored);
  const bool whole = options.estimate_colors == 1 || options.estimate_normals == 1;
  const CloudCounts counts = whole   ? write_from_memory(fusion)
                             : tiled ? write_tiles(fusion)
                                     : write_in_a_stream(fusion);
  report_counts(output.report, counts, run.context);
  return counts.points;
}

std::size_t write_tile(const Run& run, const FusionOptions& options, const OutputOptions& output,
                       std::size_t tile) {
  map_large_blocks();
  return TileRun({run, options, output}).make(tile).points;
}

}  // namespace axial::densify
