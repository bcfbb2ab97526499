// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <memory>
#include <mutex>

#include "axial/map.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "io/images/image.h"
#include "map/contours.h"
#include "map/geotiff.h"
#include "map/map_block.h"
#include "map/overview.h"
#include "map/stated_kind.h"
#include "map/surface_block.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

constexpr int kJpegQuality = 92;

// In the order of MapFiles::all().
constexpr fs::path MapFiles::*kMembers[] = {
    &MapFiles::heights, &MapFiles::colors,          &MapFiles::counts,
    &MapFiles::errors,  &MapFiles::shades,          &MapFiles::contours,
    &MapFiles::picture, &MapFiles::contour_package, &MapFiles::contour_drawing};

// The open maps. Blocks are written by one thread at a time.
class OpenMaps {
 public:
  OpenMaps(const MapFiles& files, const MapContent& content, const WriteOptions& options) {
    const WorldAxes axes = world_axes(content.frame, options.mesh_frame);
    const auto open = [&](const fs::path& path, MapKind kind, const char* stated) {
      if (path.empty()) return std::unique_ptr<GeoTiff>();
      auto map = std::make_unique<GeoTiff>(path, kind, content.grid, options.crs);
      map->state_axes(axes);
      map->state_kind(stated);
      return map;
    };
    heights_ = open(files.heights, MapKind::heights, kinds::kHeights);
    colors_ = open(files.colors, MapKind::colors, kinds::kColors);
    counts_ = open(files.counts, MapKind::counts, kinds::kCounts);
    errors_ = open(files.errors, MapKind::heights, kinds::kErrors);
    shades_ = open(files.shades, MapKind::shades, kinds::kShades);
  }

  void write(const MapBlock& block) {
    const std::lock_guard lock(mutex_);
    if (block.is_empty) return;
    if (heights_) heights_->write(block.pixels, block.heights);
    if (colors_) colors_->write(block.pixels, block.colors);
    if (counts_) counts_->write(block.pixels, block.counts);
    if (errors_) errors_->write(block.pixels, block.errors);
    if (shades_) shades_->write(block.pixels, block.shades);
    report_.surface += cv::countNonZero(block.heights != kNoHeight);
    if (block.colors.empty()) return;
    cv::Mat1b alpha;
    cv::extractChannel(block.colors, alpha, 3);
    report_.colored += cv::countNonZero(alpha);
  }

  // One file after the other: GDAL shares its cache between open files, and a thread that needs
  // room in the cache writes blocks of the files of other threads.
  MapReport finish(const ProgressSink& progress) {
    std::vector<std::unique_ptr<GeoTiff>*> maps;
    for (auto* map : {&heights_, &colors_, &counts_, &errors_, &shades_})
      if (*map) maps.push_back(map);
    ProgressCounter counter(progress, maps.size());
    for (auto* map : maps) {
      (*map)->finish();
      map->reset();
      counter.add();
    }
    return report_;
  }

 private:
  std::unique_ptr<GeoTiff> heights_, colors_, counts_, errors_, shades_;
  std::mutex mutex_;
  MapReport report_;
};

// How many blocks fit into memory at the same time, with the lists of the faces.
std::size_t blocks_at_once(const MapContent& content, const WriteOptions& options, int samples,
                           const MemoryBudget& budget) {
  const std::uint64_t fixed = kCacheBytes + FaceBins::bytes(content.mesh.mesh, content.frame,
                                                            content.grid, options.block_size);
  const std::uint64_t each = bytes_of_block(options.block_size, samples);
  const std::string work =
      fmt::format("a map of {} x {} pixels", content.grid.columns, content.grid.rows);
  const auto lists = budget.reserve(fixed);
  return budget.items(each, thread_count(), work);
}

void write_picture(const fs::path& path, const fs::path& colors, const WriteOptions& options) {
  const StoredMap map = read_map(colors, options.longest_side);
  const bool is_wide = map.grid.columns > map.grid.rows;  // the longer side has less rounding
  const double reduction = is_wide ? double{1} * map.grid.columns / map.pixels.cols
                                   : double{1} * map.grid.rows / map.pixels.rows;
  io::write_jpeg(path,
                 draw_overview(map.pixels, {map.grid.pixel * reduction, options.is_georeferenced}),
                 kJpegQuality);
}

void write_further(const MapFiles& files, const Context& context) {
  if (files.further.empty()) return;
  ProgressCounter counter(context.stage("Further files"), files.further.size());
  for (const FurtherFiles& one : files.further) {
    one.write(files, one.paths);
    counter.add();
  }
}

MapReport make_maps(const MapFiles& files, const MapContent& content, const WriteOptions& options,
                    const Context& context) {
  if (options.samples == 0)
    context.memory().require(bytes_of_samples(content), "the width of a pixel in texels");
  const int samples = options.samples > 0 ? options.samples : samples_per_pixel(content);
  const std::size_t at_once = blocks_at_once(content, options, samples, context.memory());
  OpenMaps maps(files, content, options);
  {
    const FaceBins bins(content.mesh.mesh, content.frame, content.grid, options.block_size);
    ProgressCounter counter(context.stage("Maps"), bins.blocks());
    for_each_in_flight(bins.blocks(), at_once, [&](std::size_t b) {
      maps.write(make_block(content, bins, b, samples));
      counter.add();
    });
  }
  const MapReport report = maps.finish(context.stage("Files"));
  if (!files.contours.empty())
    write_contours(files.heights, options.contour_interval,
                   {files.contours, files.contour_package, files.contour_drawing});
  if (!files.picture.empty()) write_picture(files.picture, files.colors, options);
  write_further(files, context);
  return report;
}

// More lines would fill the disk.
void check_contours(const MapContent& content, const WriteOptions& options) {
  constexpr double kMost = 10000;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const Mesh& mesh = content.mesh.mesh;
  for (const auto& face : mesh.faces)
    for (const std::uint32_t corner : face) {
      const double height = content.frame.axes.row(2).dot(mesh.vertices[corner].cast<double>());
      low = std::min(low, height);
      high = std::max(high, height);
    }
  if ((high - low) / options.contour_interval > kMost)
    fail("{} {}: makes more than {} contour lines on a relief of {:.4g} m",
         setting("contour_interval"), options.contour_interval, kMost, high - low);
}

}  // namespace

std::vector<fs::path> MapFiles::all() const {
  std::vector<fs::path> paths;
  for (const auto member : kMembers)
    if (!(this->*member).empty()) paths.push_back(this->*member);
  for (const FurtherFiles& one : further)
    paths.insert(paths.end(), one.paths.begin(), one.paths.end());
  return paths;
}

MapReport write_maps(const MapFiles& files, const MapContent& content, const WriteOptions& options,
                     const Context& context) {
  check_content(content);
  if (!files.colors.empty() && content.mesh.textures.empty()) fail("the mesh has no textures");
  if (!files.counts.empty() && content.views.empty()) fail("the numbers of views are missing");
  if (!files.errors.empty() && content.errors.empty()) fail("the expected errors are missing");
  if (!files.contours.empty() && (files.heights.empty() || !(options.contour_interval > 0)))
    fail("{} {}: contour lines need an interval above 0 and the map of heights",
         setting("contour_interval"), options.contour_interval);
  if (!files.picture.empty() && files.colors.empty()) fail("a picture needs the map of colours");
  if (!files.contours.empty()) check_contours(content, options);
  for (const fs::path& path : files.all())  // of the blocks, too
    remove_abandoned(path.parent_path(), path.stem().string());
  MapReport report;
  write_together(files.all(), [&](const std::vector<fs::path>& temporaries) {
    MapFiles renamed = files;
    auto next = temporaries.begin();
    for (const auto member : kMembers)
      if (!(renamed.*member).empty()) renamed.*member = *next++;
    for (FurtherFiles& one : renamed.further)
      for (fs::path& path : one.paths) path = *next++;
    report = make_maps(renamed, content, options, context);
    if (report.surface == 0)
      fail("the map shows no surface: the mesh is upright, or smaller than a pixel");
  });
  return report;
}

}  // namespace axial::map
