// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/texture_mesh.h"

#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "scene/check_mesh.h"
#include "texture/atlas.h"
#include "texture/outliers.h"

namespace axial::texture {
namespace {

std::uint64_t bytes_of(const Mesh& mesh) {
  return mesh.vertices.size() * sizeof(mesh.vertices[0]) + mesh.colors.size() * sizeof(Rgb) +
         mesh.faces.size() * sizeof(mesh.faces[0]);
}

std::uint64_t bytes_of(const FaceViews& views) {
  return views.sights.size() * sizeof(Sight) + views.begin.size() * sizeof(views.begin[0]);
}

std::vector<std::uint32_t> label_faces(const Mesh& mesh, std::span<const View> views,
                                       const ImageSource& images, const Options& options,
                                       std::span<const FacePair> pairs, const Budget& budget,
                                       Report& report, const StageProgress& progress) {
  FaceViews seen = find_face_views(mesh, views, images, options.visibility,
                                   progress ? progress("Views of faces") : ProgressSink{},
                                   {budget, options.image_bytes});
  if (seen.sights.empty()) fail("no view sees a face of the mesh");
  return_freed_memory();
  report.outliers = remove_outliers(seen, options.outlier_threshold);
  budget.require(bytes_of(seen) + bytes_to_choose_views(seen),
                 fmt::format("choosing the views of {} faces", mesh.faces.size()));
  return choose_views(seen, pairs, options.labels);
}

// The most photographs that are painted at the same time.
std::size_t painted_at_once(std::span<const View> views, const Options& options,
                            const Budget& budget) {
  std::uint64_t pixels = 0;
  for (const View& view : views)
    pixels = std::max(pixels, static_cast<std::uint64_t>(view.camera.width) *
                                  static_cast<std::uint64_t>(view.camera.height));
  return budget.items(0, options.image_bytes + bytes_to_paint(pixels), thread_count(),
                      "painting textures");
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

// Error if there is no memory to write the result. It is known as soon as the textures are laid
// out.
void check_writing(const Mesh& mesh, const Atlas& atlas, const Options& options,
                   const Budget& budget) {
  ResultSize size{mesh.vertices.size(), mesh.faces.size(), {}};
  for (const cv::Mat3b& texture : atlas.textures) size.textures.push_back(texture.size());
  constexpr std::uint64_t kOfFace = sizeof(TexturedMesh::Corners) + sizeof(std::uint32_t);
  budget.require(size.faces * kOfFace + bytes_of_textures(size.textures) +
                     (options.bytes_to_write ? options.bytes_to_write(size) : 0),
                 fmt::format("writing {} textures", size.textures.size()));
}

// Textures that are painted and levelled. `budget`: what the charts leave.
Atlas make_textures(const Mesh& mesh, const Charts& charts, std::span<const FacePair> pairs,
                    std::span<const View> views, const ImageSource& images, const Options& options,
                    const Budget& budget) {
  Atlas atlas = lay_out(charts, options.packing, options.empty_color, budget);
  if (atlas.scaled_down > 0)
    log_warning("{} parts of photographs are larger than a texture and are scaled down",
                atlas.scaled_down);
  check_writing(mesh, atlas, options, budget);
  std::uint64_t held = atlas.uv.size() * sizeof(atlas.uv[0]);
  for (const cv::Mat3b& texture : atlas.textures) held += texture.total() * sizeof(cv::Vec3b);
  const Budget rest = budget.without(held, "painting textures");
  paint(atlas, charts, views.size(), images, options.sharpness_weight,
        painted_at_once(views, options, rest));
  return_freed_memory();
  level_seams(atlas, mesh, charts, find_seams(charts, mesh, pairs), options.leveling, rest);
  return atlas;
}

}  // namespace

TexturedMesh texture_mesh(Mesh mesh, std::span<const View> views, const ImageSource& images,
                          const Options& options, Report* report, const StageProgress& progress) {
  check_mesh(mesh);
  Report own;
  Report& facts = report ? *report : own;
  facts = {};
  const std::uint64_t given = bytes_of(mesh);
  Budget budget(options.max_bytes, options.name_of);
  facts.new_faces = split_faces(mesh, views, options.split, budget);
  budget = budget.without(bytes_of(mesh) - given, "splitting faces");
  budget.require(bytes_to_pair(mesh.faces.size()), "listing the edges of the mesh");
  const std::vector<FacePair> pairs = face_pairs(mesh.faces);
  budget = budget.without(pairs.size() * sizeof(FacePair), "listing the edges of the mesh");
  const std::vector<std::uint32_t> labels =
      label_faces(mesh, views, images, options, pairs, budget, facts, progress);
  return_freed_memory();
  facts.unseen_faces = static_cast<std::size_t>(std::ranges::count(labels, kNoView));
  budget = budget.without(labels.size() * sizeof(labels[0]) +
                              bytes_of_charts(labels.size(), most_nodes(mesh, pairs, labels)),
                          "joining faces to charts");
  const Charts charts = make_charts(mesh, pairs, labels, views);
  facts.charts = charts.charts.size();
  Atlas atlas = make_textures(mesh, charts, pairs, views, images, options, budget);
  facts.scaled_down = atlas.scaled_down;
  return assemble(std::move(mesh), charts, std::move(atlas));
}

}  // namespace axial::texture
