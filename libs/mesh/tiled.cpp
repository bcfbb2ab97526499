// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/tiled.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "cloud/crop.h"
#include "io/openmvs/point_source.h"
#include "mesh/tile_files.h"

namespace axial::mesh {
namespace {

constexpr std::size_t kSample = 1 << 20;

// Every k-th point of a cloud whose size is not known. Of a larger cloud, the sample has from
// kSample to 2 * kSample points.
class Sample {
 public:
  void add(const Eigen::Vector3f& point) {
    if (seen_++ % step_ != 0) return;
    points_.push_back(point);
    if (points_.size() < 2 * kSample) return;
    for (std::size_t i = 0; i < kSample; ++i) points_[i] = points_[2 * i];
    points_.resize(kSample);
    step_ *= 2;
  }
  const std::vector<Eigen::Vector3f>& points() const { return points_; }

 private:
  std::vector<Eigen::Vector3f> points_;
  std::size_t seen_ = 0, step_ = 1;
};

class TiledRun {
 public:
  TiledRun(const CloudSource& cloud, const Scene& scene, const ReconstructOptions& options,
           const TileRun& run, const Context& context)
      : cloud_(cloud),
        scene_(scene),
        rays_(scene),
        options_(options),
        context_(context),
        count_(run.tiles),
        margin_(run.margin),
        files_(run.folder, origin_of(run)) {
    if (options.clean.decimate != 1 || options.clean.target_faces > 0 ||
        options.clean.edge_length > 0)
      fail("a mesh in tiles cannot be simplified or remeshed");
    options_.clean.may_be_empty = true;
    if (files_.has_others())
      context.warning("{}: has tiles of other input or options, which are not used",
                      run.folder.string());
    divide_cloud();
  }

  TileMesh tile_mesh(std::size_t tile) const {
    if (std::optional<TileMesh> made = files_.mesh(tile)) return std::move(*made);
    MergedPoints own = points_of(tile);
    const std::size_t own_points = own.size();
    MergedPoints points = with_margin(tile, std::move(own));
    context_.info("Tile {} of {}: {} merged points, {} of them in the tile", tile + 1, count_,
                  points.size(), own_points);
    const TileMesh mesh = owned_part(mesh_of(tile, std::move(points)), tiles_[tile]);
    return_freed_memory();
    files_.write(tile, mesh);
    return mesh;
  }

  Mesh joined() const {
    std::size_t vertices = 0;
    for (std::size_t tile = 0; tile < count_; ++tile)
      vertices += tile_mesh(tile).mesh.vertices.size();
    require_memory(bytes_to_join(vertices), fmt::format("a mesh of {} vertices", vertices));
    std::vector<TileMesh> meshes;
    for (std::size_t tile = 0; tile < count_; ++tile) meshes.push_back(tile_mesh(tile));
    JoinOptions join;
    join.spurious = options_.clean.spurious;
    JoinReport report;
    Mesh mesh = join_tiles(std::move(meshes), join, &report);
    context_.info(
        "Joined {} tiles: {} of {} edges between tiles differ, {} faces around them mended", count_,
        report.unmatched, report.seams, report.replaced_faces);
    if (mesh.faces.empty()) fail("no surface separates free space from points");
    return mesh;
  }

  // The identifier of the run with all that decides on the tiles.
  static std::string origin_of(const TileRun& run) {
    return Fingerprint().add(run.made_from).add(std::uint64_t{run.tiles}).add(run.margin).hex();
  }

 private:
  // Errors name the tile.
  Mesh mesh_of(std::size_t tile, MergedPoints points) const {
    try {
      return reconstruct_merged(std::move(points), scene_, rays_, options_, context_);
    } catch (const Error& error) {
      fail("tile {} of {}: {}", tile + 1, count_, error.text());
    }
  }

  void require_memory(std::uint64_t bytes, const std::string& work) const {
    const MemoryBudget& memory = context_.memory();
    if (memory.is_limited() && bytes > memory.limit())
      fail("{} needs about {} MB, but {} is {}", work, bytes / kMegabyte, setting("max_memory"),
           memory.limit() / kMegabyte);
  }

  // Passes the points to use to `sink`, and the properties of the cloud.
  void read(const std::string& title,
            const std::function<void(PointCloud, const io::CloudLayout&)>& sink) const {
    const ProgressSink progress = context_.stage(title);
    std::size_t done = 0;
    cloud_([&](PointCloud portion, std::size_t all) {
      check_points(portion, scene_, done);
      done += portion.size();
      const io::CloudLayout layout{.normals = !portion.normals.empty(),
                                   .views = true,
                                   .view_weights = !portion.view_weights.empty()};
      if (options_.only_region && scene_.region) cloud::crop(portion, *scene_.region);
      sink(std::move(portion), layout);
      progress(done, all);
    });
    if (done == 0) fail("the cloud has no points");
  }

  bool is_divided() {
    const auto made = files_.tiles();
    if (!made || made->size() != count_) return false;
    for (std::size_t tile = 0; tile < count_; ++tile)
      if (!std::filesystem::is_regular_file(files_.cloud(tile))) return false;
    tiles_ = *made;
    return true;
  }

  void divide_cloud() {
    if (is_divided()) return;
    files_.make_folders();
    Sample sample;
    read("Read points", [&](const PointCloud& portion, const io::CloudLayout&) {
      for (const Eigen::Vector3f& position : portion.positions) sample.add(position);
    });
    tiles_ = cloud::make_tiles(sample.points(), count_, cloud::tile_axes(scene_));
    write_clouds();
    files_.write(tiles_);
  }

  // The points of a portion in each tile.
  std::vector<PointCloud> parts_of(const PointCloud& portion) const {
    std::vector<PointCloud> parts(count_);
    for (PointCloud& part : parts) part.view_begin.push_back(0);
    std::size_t tile = 0;  // the next point is often in the same tile
    for (std::size_t i = 0; i < portion.size(); ++i) {
      const Eigen::Vector3d place = portion.positions[i].cast<double>();
      while (!tiles_[tile].contains(place)) tile = (tile + 1) % count_;
      append(portion, i, parts[tile]);
    }
    return parts;
  }

  // Appends point `i` of `from` to `to`, without its colour.
  static void append(const PointCloud& from, std::size_t i, PointCloud& to) {
    to.positions.push_back(from.positions[i]);
    if (!from.normals.empty()) to.normals.push_back(from.normals[i]);
    for (std::size_t v = from.view_begin[i]; v < from.view_begin[i + 1]; ++v) {
      to.view_images.push_back(from.view_images[v]);
      if (!from.view_weights.empty()) to.view_weights.push_back(from.view_weights[v]);
    }
    to.view_begin.push_back(to.view_images.size());
  }

  void write_clouds() const {
    std::vector<std::unique_ptr<io::CloudWriter>> writers(count_);
    read("Divided points", [&](const PointCloud& portion, const io::CloudLayout& layout) {
      const std::vector<PointCloud> parts = parts_of(portion);
      for (std::size_t tile = 0; tile < count_; ++tile) {
        if (!writers[tile])
          writers[tile] = std::make_unique<io::CloudWriter>(files_.cloud(tile), layout);
        writers[tile]->add(parts[tile]);
      }
    });
    for (const auto& writer : writers) writer->finish();
  }

  MergedPoints points_of(std::size_t tile) const {
    if (std::optional<MergedPoints> made = files_.points(tile)) return std::move(*made);
    const std::filesystem::path file = files_.cloud(tile);
    require_memory(io::bytes_to_read_cloud(file), "reading " + file.string());
    MergedPoints points = merge_points(io::read_cloud_ply(file), rays_, options_.merge);
    files_.write(tile, points);
    return points;
  }

  static bool meet(const cloud::Tile& a, const cloud::Tile& b) {
    return (a.low.array() <= b.high.array()).all() && (a.high.array() >= b.low.array()).all();
  }

  // The points inside `box` of all tiles but `tile`.
  MergedPoints others_inside(std::size_t tile, const cloud::Tile& box) const {
    MergedPoints points;
    for (std::size_t other = 0; other < count_; ++other)
      if (other != tile && meet(tiles_[other], box)) append(points_of(other), box, points);
    return points;
  }

  // `points`, the points of the tile, with those of other tiles in its margin. The margin of a tile
  // without points is that of the tiles around it.
  MergedPoints with_margin(std::size_t tile, MergedPoints points) const {
    MergedPoints around;
    if (points.size() == 0)
      for (std::size_t other = 0; other < count_; ++other)
        if (meet(tiles_[other], tiles_[tile])) append(points_of(other), {}, around);
    const MergedPoints& typical = points.size() > 0 ? points : around;
    if (typical.size() == 0) return points;
    const cloud::Tile reach =
        cloud::grown(tiles_[tile], cloud::tile_margin(margin_, typical.pixel_widths));
    append(others_inside(tile, reach), {}, points);
    sort_in_space(points);
    return points;
  }

  // Appends the points inside `box`.
  static void append(const MergedPoints& more, const cloud::Tile& box, MergedPoints& points) {
    for (std::size_t i = 0; i < more.size(); ++i) {
      if (!box.contains(more.positions[i].cast<double>())) continue;
      points.positions.push_back(more.positions[i]);
      points.pixel_widths.push_back(more.pixel_widths[i]);
      for (std::size_t v = more.view_begin[i]; v < more.view_begin[i + 1]; ++v) {
        points.view_images.push_back(more.view_images[v]);
        points.view_weights.push_back(more.view_weights[v]);
      }
      points.view_begin.push_back(points.view_images.size());
    }
    points.count = points.size();
  }

  const CloudSource& cloud_;
  const Scene& scene_;
  ViewRays rays_;
  ReconstructOptions options_;
  const Context& context_;
  std::size_t count_;
  double margin_;
  TileFiles files_;
  std::vector<cloud::Tile> tiles_;
};

}  // namespace

Mesh reconstruct_in_tiles(const CloudSource& cloud, const Scene& scene,
                          const ReconstructOptions& options, const TileRun& run,
                          const Context& context) {
  return TiledRun(cloud, scene, options, run, context).joined();
}

void reconstruct_tile(std::size_t tile, const CloudSource& cloud, const Scene& scene,
                      const ReconstructOptions& options, const TileRun& run,
                      const Context& context) {
  TiledRun(cloud, scene, options, run, context).tile_mesh(tile);
}

void remove_intermediate_files(const TileRun& run) {
  TileFiles(run.folder, TiledRun::origin_of(run)).remove();
}

}  // namespace axial::mesh
