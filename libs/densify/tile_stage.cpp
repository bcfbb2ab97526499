// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/tile_stage.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "densify/depth_stage.h"
#include "densify/fusion_stage.h"
#include "densify/fusion_tiles.h"
#include "densify/tile_files.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

void add_plane(Fingerprint& print, const cv::Mat& plane) {
  print.add(static_cast<std::uint64_t>(plane.rows)).add(static_cast<std::uint64_t>(plane.cols));
  const std::size_t bytes = static_cast<std::size_t>(plane.cols) * plane.elemSize();
  for (int y = 0; y < plane.rows; ++y)
    print.add({reinterpret_cast<const char*>(plane.ptr(y)), bytes});
}

void add_box(Fingerprint& print, const cloud::Tile& box) {
  for (const double value : box.rotation.reshaped()) print.add(value);
  for (const double value : box.low) print.add(value);
  for (const double value : box.high) print.add(value);
}

// Everything besides the depth maps and the tile on which the points depend.
void add_fusion_settings(Fingerprint& print, const FusionRun& run) {
  const Settings& settings = run.settings;
  // Normals are a setting of their own, and the part is added for each tile. The last two do not
  // change the points. A new member does not compile until it has a name here.
  const auto& [min_views, two_if_undisputed, depth_threshold, normal_threshold, normals, errors,
               part, max_maps, max_loads] = settings.fusion;
  for (const std::uint64_t value :
       {std::uint64_t{min_views}, std::uint64_t{two_if_undisputed}, std::uint64_t{errors},
        std::uint64_t{settings.estimate_colors}, std::uint64_t{settings.estimate_normals},
        std::uint64_t{settings.double_precision}})
    print.add(value);
  print.add(depth_threshold).add(normal_threshold);
  for (const double value : run.project.frame.origin) print.add(value);
  const auto& region = run.project.scene.region;
  print.add(std::uint64_t{settings.crop_to_roi && region});
  if (!settings.crop_to_roi || !region) return;
  for (const double value : region->rotation.reshaped()) print.add(value);
  for (const double value : region->centre) print.add(value);
  for (const double value : region->half_extent) print.add(value);
}

class TileRun {
 public:
  explicit TileRun(const FusionRun& run)
      : run_(run),
        views_(views_to_fuse(run.project)),
        parts_(tiles_of(run.project, run.settings)),
        contents_(views_.size()) {
    look_at_maps();
  }

  // Makes the tile (from 1) unless its file is there already.
  CloudCounts make(std::size_t tile) const {
    const fs::path ply = tile_file(run_.settings, tile);
    const std::string stamp = made_from(tile);
    if (const auto counts = finished_tile(ply, stamp)) {
      log_info("{}: exists already, {} points", ply.string(), counts->points);
      return *counts;
    }
    remove_tile(ply);
    const CloudCounts counts = fuse(tile, ply);
    finish_tile(ply, stamp, counts, parts_[tile - 1].tile);
    return counts;
  }

  // Error if a tile needs more memory than the plan has.
  void require_memory() const {
    for (std::size_t tile = 1; tile <= parts_.size(); ++tile)
      most_maps(tile, cloud::views_needed(views_, parts_[tile - 1]));
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
    ProgressCounter counter(console_progress("Assigned depth maps to tiles"), views_.size());
    for_each_in_flight(views_.size(), run_.plan.fusion_loads, [&](std::size_t view) {
      const DepthMap map = load_final_map(run_, views_[view].image);
      Fingerprint print;
      for (const cv::Mat& plane :
           {cv::Mat(map.depth), cv::Mat(map.normal), cv::Mat(map.confidence)})
        add_plane(print, plane);
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
    add_fusion_settings(print, run_);
    for (std::size_t i = 0; i < views_.size(); ++i)
      print.add(std::uint64_t{views_[i].image}).add(views_[i].rank).add(contents_[i]);
    print.add(std::uint64_t{tile}).add(std::uint64_t{parts_.size()});
    add_box(print, parts_[tile - 1].tile);
    add_box(print, parts_[tile - 1].reach);
    return print.hex();
  }

  // FuseOptions::max_maps for a tile that marks the pixels of `needed` views. The plan has memory
  // for an estimated number of views. If there are more, fewer maps are kept.
  std::size_t most_maps(std::size_t tile, std::size_t needed) const {
    // A map has at least 20 bytes a pixel, as much as the marks of 160 views.
    constexpr std::size_t kViewsPerMap = 160;
    const std::size_t planned = run_.plan.marked_views;
    const std::size_t fewer =
        needed > planned ? (needed - planned + kViewsPerMap - 1) / kViewsPerMap : 0;
    if (run_.plan.fused_maps < run_.plan.least_fused_maps + fewer)
      fail(
          "{} {}: tile {} of {} needs {} views, more than expected: allow more memory or use {} {}",
          run_.settings.name_of("max_memory"), run_.settings.survey.memory.megabytes, tile,
          parts_.size(), needed, run_.settings.name_of("fusion_tiles"), 2 * parts_.size());
    return run_.plan.fused_maps - fewer;
  }

  CloudCounts fuse(std::size_t tile, const fs::path& ply) const {
    const cloud::FusionPart& part = parts_[tile - 1];
    const auto seen = std::ranges::count(part.seen_by, true);
    const std::size_t maps = most_maps(tile, cloud::views_needed(views_, part));
    const std::string title = fmt::format("Fused tile {} of {}", tile, parts_.size());
    io::CloudWriter writer(ply, layout_of(run_.settings),
                           placement_of(run_.project, run_.settings));
    const CloudCounts counts = fuse_maps(run_, views_, part, maps, title,
                                         [&](const PointCloud& portion) { writer.add(portion); });
    writer.finish();
    log_info("Tile {} of {}: {} points, seen by {} of {} views", tile, parts_.size(), counts.points,
             seen, views_.size());
    return counts;
  }

  const FusionRun& run_;
  std::vector<cloud::FusionView> views_;
  std::vector<cloud::FusionPart> parts_;
  std::vector<std::string> contents_;  // fingerprints of the maps of `views_`
};

}  // namespace

void require_final_maps(const Project& project, const Settings& settings,
                        const ExistingMaps& existing) {
  const std::string wanted = final_made_from(project, settings);
  for (const std::size_t image : project.references) {
    const io::DmapStatus& map = existing[image];
    if (map.origin == io::DmapOrigin::ours && map.made_from == wanted) continue;
    const char* fault = map.origin == io::DmapOrigin::none      ? "does not exist"
                        : map.origin == io::DmapOrigin::damaged ? "is damaged"
                        : map.origin == io::DmapOrigin::foreign
                            ? "was written by another program"
                            : "was made from other input or with other options";
    fail(
        "{}: the depth map {}, and {} makes no depth maps: make all depth maps first, in a run "
        "without it",
        depth_map_path(project, settings, image).string(), fault, settings.name_of("tile"));
  }
}

CloudCounts write_tile(const FusionRun& run) {
  return TileRun(run).make(run.settings.tile);
}

CloudCounts write_tiles(const FusionRun& run, const fs::path& ply) {
  const TileRun tiles(run);
  tiles.require_memory();
  io::CloudWriter writer(ply, layout_of(run.settings), placement_of(run.project, run.settings));
  CloudCounts all;
  const std::size_t count = run.settings.fusion_tiles;
  for (std::size_t tile = 1; tile <= count; ++tile) {
    const CloudCounts counts = tiles.make(tile);
    writer.add_file(tile_file(run.settings, tile), counts.points);
    all.add(counts);
  }
  writer.finish();
  return all;
}

}  // namespace axial::densify
