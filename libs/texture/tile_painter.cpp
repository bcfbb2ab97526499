// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/tile_painter.h"

#include <algorithm>

#include "base/memory.h"
#include "base/parallel.h"
#include "geometry/posed_camera.h"

namespace axial::texture {
namespace {

// The most photographs that are painted at the same time.
std::size_t painted_at_once(const Sources& sources, const MemoryBudget& budget) {
  const std::uint64_t pixels = geometry::most_pixels(sources.views);
  return budget.items(sources.options.image_bytes + bytes_to_paint(pixels), thread_count(),
                      "painting textures");
}

std::uint64_t bytes_of_atlas(const Atlas& atlas) {
  return atlas.uv.size() * sizeof(atlas.uv[0]) +
         atlas.rects.size() *
             (2 * sizeof(cv::Rect) + sizeof(cv::Point) + 2 * sizeof(std::uint32_t));
}

// The numbers of faces of each tile, and upper bounds of the numbers of vertices.
std::vector<ResultSize> sizes_of_tiles(const Mesh& mesh, const Charts& charts,
                                       const FaceTiles& tiles, const Atlas& atlas) {
  std::vector<ResultSize> sizes(tiles.count());
  for (std::size_t tile = 0; tile < sizes.size(); ++tile) sizes[tile].textures = atlas.sizes[tile];
  if (tiles.count() == 1) {
    sizes[0].vertices = mesh.vertices.size(), sizes[0].faces = mesh.faces.size();
    return sizes;
  }
  for (const Node& node : charts.nodes) ++sizes[atlas.tiles.of(node.chart)].vertices;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    ResultSize& size = sizes[tiles.of_face[f]];
    ++size.faces;
    if (charts.chart_of[f] == kNoChart) size.vertices += 3;
  }
  for (ResultSize& size : sizes) size.vertices = std::min(size.vertices, mesh.vertices.size());
  return sizes;
}

}  // namespace

ChartTiles give_charts(FaceTiles& tiles, const Charts& charts) {
  ChartTiles result{tiles.count(), {}};
  if (tiles.count() == 1) return result;
  std::vector<std::uint32_t> counts(tiles.count(), 0);
  for (std::size_t c = 0; c < charts.charts.size(); ++c) {
    const std::span<const std::uint32_t> faces = charts.faces.of(c);
    for (const std::uint32_t f : faces) ++counts[tiles.of_face[f]];
    std::uint32_t most = tiles.of_face[faces[0]];
    for (const std::uint32_t f : faces) {
      const std::uint32_t tile = tiles.of_face[f];
      if (counts[tile] > counts[most] || (counts[tile] == counts[most] && tile < most)) most = tile;
    }
    for (const std::uint32_t f : faces) {
      counts[tiles.of_face[f]] = 0;
      tiles.of_face[f] = most;
    }
    result.of_chart.push_back(most);
  }
  return result;
}

TilePainter::TilePainter(Mesh& mesh, const Charts& charts, std::span<const FacePair> pairs,
                         const FaceTiles& tiles, ChartTiles of_charts, const Sources& sources,
                         const MemoryBudget& budget)
    : mesh_(mesh),
      charts_(charts),
      tiles_(tiles),
      sources_(sources),
      seams_(find_seams(charts, mesh, pairs)),
      atlas_(plan_atlas(charts, std::move(of_charts), sources.options.packing)),
      budget_(budget),
      of_atlas_(budget_.reserve(bytes_of_atlas(atlas_) + seams_.size() * sizeof(Seam),
                                fmt::format("packing {} charts", charts.charts.size()))) {
  if (atlas_.scaled_down > 0)
    sources_.context.warning(
        "{} parts of photographs are larger than a texture and are scaled down",
        atlas_.scaled_down);
  check_writing();
}

bool TilePainter::levelled() const {
  const LevelingOptions& options = sources_.options.leveling;
  return !seams_.empty() && (options.global || options.local);
}

std::uint64_t TilePainter::bytes_of_corrections() const {
  if (!levelled()) return 0;
  return bytes_of_seams(atlas_, seams_) + charts_.nodes.size() * sizeof(Eigen::Vector3f);
}

// Error if there is no memory to write a result. It is known as soon as the textures are planned.
void TilePainter::check_writing() const {
  constexpr std::uint64_t kOfFace = sizeof(TexturedMesh::Corners) + sizeof(std::uint32_t);
  // The corrections are in memory until the last tile is levelled.
  const std::uint64_t held = tiles_.count() > 1 ? bytes_of_corrections() : 0;
  for (const ResultSize& size : sizes_of_tiles(mesh_, charts_, tiles_, atlas_)) {
    const std::uint64_t part = tiles_.count() > 1 ? bytes_of_part(size.vertices, size.faces) : 0;
    const auto& to_write = sources_.options.bytes_to_write;
    sources_.less_by_tiles(budget_).require(
        held + part + size.faces * kOfFace + bytes_of_textures(size.textures) +
            (to_write ? to_write(size) : 0),
        fmt::format("writing {} textures", size.textures.size()));
  }
}

Corrections TilePainter::corrections_of_all() {
  const LevelingOptions& options = sources_.options.leveling;
  of_corrections_ =
      budget_.reserve(bytes_of_corrections(), fmt::format("levelling {} seams", seams_.size()));
  SeamColors colors = seam_samples(atlas_, seams_);
  for (std::size_t tile = 0; tile < tiles_.count(); ++tile) {
    paint_tile(tile);
    add_seam_colors(colors, atlas_, charts_, seams_);
  }
  if (tiles_.count() > 1) atlas_.textures.clear();
  return_freed_memory();
  const auto painted =
      budget_.reserve(bytes_of_textures(tiles_.count() > 1 ? std::span<const cv::Size>()
                                                           : std::span(atlas_.sizes[0])),
                      "painting textures");
  return find_corrections(mesh_, charts_, seams_, std::move(colors), options, budget_);
}

void TilePainter::paint_tile(std::size_t tile) {
  const MemoryBudget budget = sources_.less_by_tiles(budget_);
  begin_tile(atlas_, tile, sources_.options.empty_color, budget);
  const auto painted = budget.reserve(bytes_of_textures(atlas_.sizes[tile]), "painting textures");
  paint(atlas_, charts_, sources_.views.size(), sources_.images, sources_.options.sharpness_weight,
        painted_at_once(sources_, budget));
  return_freed_memory();
}

TexturedMesh TilePainter::assemble(std::size_t tile) {
  TexturedMesh result;
  std::vector<std::uint32_t> faces;  // in the whole mesh; empty: all
  if (tiles_.count() > 1) {
    faces = faces_of(tiles_, tile);
    result.mesh = mesh_of_faces(mesh_, faces).mesh;
  } else {
    result.mesh = std::move(mesh_);
  }
  result.uv.resize(result.mesh.faces.size());
  result.texture_of.assign(result.mesh.faces.size(), 0);
  for (std::size_t i = 0; i < result.mesh.faces.size(); ++i) {
    const std::size_t f = faces.empty() ? i : faces[i];
    const std::uint32_t chart = charts_.chart_of[f];
    if (chart == kNoChart) {
      result.uv[i].fill(atlas_.empty_uv);
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k)
      result.uv[i][k] = atlas_.in_texture(charts_.corners[f][k], chart);
    result.texture_of[i] = atlas_.texture_of[chart];
  }
  result.textures = std::move(atlas_.textures);
  atlas_.textures.clear();
  return result;
}

void TilePainter::run(const TileSink& take) {
  const bool levels = levelled();
  Corrections corrections;
  if (levels) corrections = corrections_of_all();
  for (std::size_t tile = 0; tile < tiles_.count(); ++tile) {
    if (tiles_.count() > 1 && std::ranges::count(tiles_.of_face, tile) == 0) {
      take(tile, {});
      continue;
    }
    if (!levels || tiles_.count() > 1) paint_tile(tile);
    if (levels) {
      const auto painted =
          budget_.reserve(bytes_of_textures(atlas_.sizes[tile]), "painting textures");
      level_charts(atlas_, charts_, seams_, corrections, sources_.options.leveling, budget_);
    }
    if (tile + 1 == tiles_.count()) corrections = {};
    take(tile, assemble(tile));
    return_freed_memory();
  }
}

}  // namespace axial::texture
