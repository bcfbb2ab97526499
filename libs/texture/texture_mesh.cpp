// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/texture_mesh.h"

#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "scene/check_mesh.h"
#include "texture/atlas.h"
#include "texture/outliers.h"

namespace axial::texture {
namespace {

std::vector<std::uint32_t> label_faces(const Mesh& mesh, std::span<const View> views,
                                       const ImageSource& images, const Options& options,
                                       std::span<const FacePair> pairs, Report& report,
                                       const StageProgress& progress) {
  FaceViews seen = find_face_views(mesh, views, images, options.visibility,
                                   progress ? progress("Views of faces") : ProgressSink{});
  if (seen.sights.empty()) fail("no view sees a face of the mesh");
  report.outliers = remove_outliers(seen, options.outlier_threshold);
  return choose_views(seen, pairs, options.labels);
}

TexturedMesh assemble(Mesh mesh, const Charts& charts, Atlas atlas) {
  TexturedMesh result;
  result.uv.resize(mesh.faces.size());
  result.texture_of.assign(mesh.faces.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::uint32_t chart = charts.chart_of[f];
    if (chart == kNoChart) {
      result.uv[f].fill(atlas.empty_uv);
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) result.uv[f][k] = atlas.uv[charts.corners[f][k]];
    result.texture_of[f] = atlas.texture_of[chart];
  }
  result.mesh = std::move(mesh);
  result.textures = std::move(atlas.textures);
  return result;
}

}  // namespace

TexturedMesh texture_mesh(Mesh mesh, std::span<const View> views, const ImageSource& images,
                          const Options& options, Report* report, const StageProgress& progress) {
  check_mesh(mesh);
  Report own;
  Report& facts = report ? *report : own;
  facts = {};
  facts.new_faces = split_faces(mesh, views, options.split);
  const std::vector<FacePair> pairs = face_pairs(mesh.faces);
  const std::vector<std::uint32_t> labels =
      label_faces(mesh, views, images, options, pairs, facts, progress);
  return_freed_memory();
  facts.unseen_faces = static_cast<std::size_t>(std::ranges::count(labels, kNoView));
  const Charts charts = make_charts(mesh, pairs, labels, views);
  facts.charts = charts.charts.size();
  Atlas atlas = lay_out(charts, options.packing, options.empty_color);
  facts.scaled_down = atlas.scaled_down;
  if (atlas.scaled_down > 0)
    log_warning("{} parts of photographs are larger than a texture and are scaled down",
                atlas.scaled_down);
  paint(atlas, charts, views.size(), images, options.sharpness_weight);
  level_seams(atlas, mesh, charts, find_seams(charts, mesh, pairs), options.leveling);
  return assemble(std::move(mesh), charts, std::move(atlas));
}

}  // namespace axial::texture
