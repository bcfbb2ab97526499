// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "axial/texture.h"
#include "base/memory.h"
#include "scene/check_mesh.h"
#include "texture/faces/face_labels.h"
#include "texture/faces/labels.h"
#include "texture/faces/split_faces.h"
#include "texture/tile_painter.h"

namespace axial::texture {
namespace {

std::uint64_t bytes_of(const Mesh& mesh) {
  return mesh.vertices.size() * sizeof(mesh.vertices[0]) + mesh.colors.size() * sizeof(Rgb) +
         mesh.faces.size() * sizeof(mesh.faces[0]) + mesh.unseen.size();
}

}  // namespace

TexturedMesh texture_mesh(Mesh mesh, std::span<const View> views, const ImageSource& images,
                          const Options& options, Report* report, const Context& context) {
  Options whole = options;
  whole.tiles = 1;
  TexturedMesh result;
  texture_tiles(
      std::move(mesh), views, images, whole,
      [&](std::size_t, TexturedMesh textured) { result = std::move(textured); }, report, context);
  return result;
}

void texture_tiles(Mesh mesh, std::span<const View> views, const ImageSource& images,
                   const Options& options, const TileSink& take, Report* report,
                   const Context& context) {
  check_mesh(mesh);
  Report own;
  Report& facts = report ? *report : own;
  facts = {};
  const std::uint64_t given = bytes_of(mesh);
  const MemoryBudget budget = context.memory().share();
  facts.new_faces = split_faces(mesh, views, options.split, budget, context);
  const auto of_split = budget.reserve(bytes_of(mesh) - given, "splitting faces");
  budget.require(bytes_to_pair(mesh.faces.size()), "listing the edges of the mesh");
  const std::vector<FacePair> pairs = face_pairs(mesh.faces);
  const auto of_pairs =
      budget.reserve(pairs.size() * sizeof(FacePair), "listing the edges of the mesh");
  const auto of_tiles = budget.reserve(bytes_to_divide(mesh, options.tiles), "dividing the mesh");
  FaceTiles tiles = divide_faces(mesh, options.tiles, options.axes);
  const Sources sources{views, images, options, context};
  const std::vector<std::uint32_t> labels = label_faces(mesh, pairs, tiles, sources, budget, facts);
  return_freed_memory();
  facts.unseen_faces = static_cast<std::size_t>(std::ranges::count(labels, kNoView));
  const auto of_charts =
      budget.reserve(labels.size() * sizeof(labels[0]) +
                         bytes_of_charts(labels.size(), most_nodes(mesh, pairs, labels)),
                     "joining faces to charts");
  const Charts charts = make_charts(mesh, pairs, labels, views);
  facts.charts = charts.charts.size();
  ChartTiles chart_tiles = give_charts(tiles, charts);
  TilePainter painter(mesh, charts, pairs, tiles, std::move(chart_tiles), sources, budget);
  facts.scaled_down = painter.scaled_down();
  painter.run(take);
}

}  // namespace axial::texture
