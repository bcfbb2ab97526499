// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/faces/face_labels.h"

#include <algorithm>

#include "base/error.h"
#include "base/memory.h"
#include "base/order_statistics.h"
#include "base/parallel.h"
#include "geometry/faces.h"
#include "texture/faces/labels.h"
#include "texture/faces/outliers.h"

namespace axial::texture {
namespace {

constexpr std::uint32_t kNotInPart = 0xFFFFFFFFu;

std::uint64_t bytes_of(const FaceViews& views) {
  return views.sights.size() * sizeof(Sight) + views.begin.size() * sizeof(views.begin[0]);
}

void require_choice(const FaceViews& seen, const MemoryBudget& budget) {
  budget.require(bytes_of(seen) + bytes_to_choose_views(seen),
                 fmt::format("choosing the views of {} faces", seen.faces()));
}

double median_edge(const Mesh& mesh) {
  constexpr std::size_t kSampled = 10'000;
  std::vector<float> lengths;
  for (std::size_t f = 0; f < mesh.faces.size(); f += mesh.faces.size() / kSampled + 1)
    for (std::size_t k = 0; k < 3; ++k)
      lengths.push_back(
          (mesh.vertices[mesh.faces[f][k]] - mesh.vertices[mesh.faces[f][(k + 1) % 3]]).norm());
  return upper_median(std::move(lengths));
}

// The faces that are labelled together. The first `free` faces have no label yet. Each of the
// others has a label and is a neighbour of one of the first.
struct Group {
  std::vector<std::uint32_t> faces;  // of the mesh
  std::size_t free = 0;
  std::vector<FacePair> pairs;  // of indices into `faces`, without vertices
};

class TileLabels {
 public:
  TileLabels(const Mesh& mesh, std::span<const FacePair> pairs, const FaceTiles& tiles)
      : mesh_(mesh),
        pairs_(pairs),
        tiles_(tiles),
        margin_(kMarginInEdges * median_edge(mesh)),
        labels_(mesh.faces.size(), kNoView),
        in_part_(mesh.faces.size(), kNotInPart) {}

  static std::uint64_t bytes(const Mesh& mesh) {
    return mesh.faces.size() * (2 * sizeof(std::uint32_t) + 1);
  }

  void label(std::size_t tile, const Surroundings& whole, const Sources& sources,
             const MemoryBudget& budget, Report& report) {
    const Group group = group_of(tile);
    if (group.faces.empty()) return;
    const std::span free = std::span(group.faces).first(group.free);
    const std::uint64_t part_bytes =
        bytes_of_part(std::min(3 * free.size(), mesh_.vertices.size()), free.size()) +
        group.faces.size() * sizeof(group.faces[0]) + group.pairs.size() * sizeof(FacePair);
    const auto part = budget.reserve(part_bytes, "listing the faces of a tile");
    FaceViews seen = look(free, tile, whole, sources, budget);
    report.outliers += without_outliers(seen, free, tile, sources.options.outlier_threshold);
    keep_labels(seen, group);
    require_choice(seen, budget);
    const auto chosen = choose_views(seen, group.pairs, sources.options.labels);
    for (std::size_t i = 0; i < group.free; ++i)
      if (tiles_.of_face[group.faces[i]] == tile) labels_[group.faces[i]] = chosen[i];
  }

  std::vector<std::uint32_t> take() { return std::move(labels_); }

 private:
  std::vector<std::uint32_t> unlabelled_near(std::size_t tile) const {
    const cloud::Tile reach = cloud::grown(tiles_.boxes[tile], margin_);
    std::vector<std::uint8_t> near(mesh_.faces.size());
    parallel_for(
        near.size(),
        [&](std::size_t f) {
          const std::uint32_t own = tiles_.of_face[f];
          near[f] = own == tile || (own > tile && reach.contains(geometry::middle_of(mesh_, f)));
        },
        kPointGrain);
    std::vector<std::uint32_t> faces;
    for (std::uint32_t f = 0; f < near.size(); ++f)
      if (near[f]) faces.push_back(f);
    return faces;
  }

  Group group_of(std::size_t tile) {
    Group group;
    group.faces = unlabelled_near(tile);
    group.free = group.faces.size();
    for (std::uint32_t i = 0; i < group.free; ++i) in_part_[group.faces[i]] = i;
    for (const FacePair& pair : pairs_) {
      if (in_part_[pair.a] >= group.free && in_part_[pair.b] >= group.free) continue;
      if (add(group, pair.a, tile) && add(group, pair.b, tile))
        group.pairs.push_back({in_part_[pair.a], in_part_[pair.b], 0, 0});
    }
    for (const std::uint32_t f : group.faces) in_part_[f] = kNotInPart;
    return group;
  }

  // Adds a face to the group if it has a label. Returns whether the face is in the group.
  bool add(Group& group, std::uint32_t face, std::size_t tile) {
    if (in_part_[face] != kNotInPart) return true;
    if (tiles_.of_face[face] >= tile || labels_[face] == kNoView) return false;
    in_part_[face] = static_cast<std::uint32_t>(group.faces.size());
    group.faces.push_back(face);
    return true;
  }

  FaceViews look(std::span<const std::uint32_t> faces, std::size_t tile, const Surroundings& whole,
                 const Sources& sources, const MemoryBudget& budget) const {
    const MeshPart part = mesh_of_faces(mesh_, faces);
    const std::string stage =
        fmt::format("Views of faces, tile {} of {}", tile + 1, tiles_.count());
    return find_face_views(part, whole, sources.views, sources.images, sources.options.visibility,
                           sources.context.stage(stage), {budget, sources.options.image_bytes});
  }

  // Returns the number of removed sights of the tile's own faces.
  std::size_t without_outliers(FaceViews& seen, std::span<const std::uint32_t> faces,
                               std::size_t tile, double threshold) const {
    const auto count = [&] {
      std::size_t sights = 0;
      for (std::size_t i = 0; i < faces.size(); ++i)
        if (tiles_.of_face[faces[i]] == tile) sights += seen.of(i).size();
      return sights;
    };
    const std::size_t before = count();
    remove_outliers(seen, threshold);
    return before - count();
  }

  // Gives the faces that have a label a single view, so that they keep it.
  void keep_labels(FaceViews& seen, const Group& group) const {
    for (std::size_t i = group.free; i < group.faces.size(); ++i) {
      seen.sights.push_back({labels_[group.faces[i]], 1, {}, true});
      seen.begin.push_back(seen.sights.size());
    }
  }

  const Mesh& mesh_;
  std::span<const FacePair> pairs_;
  const FaceTiles& tiles_;
  double margin_;
  std::vector<std::uint32_t> labels_;
  std::vector<std::uint32_t> in_part_;  // of each face: its index in the group; or kNotInPart
};

std::vector<std::uint32_t> label_in_one_piece(const Mesh& mesh, std::span<const FacePair> pairs,
                                              const Sources& sources, const MemoryBudget& budget,
                                              Report& report) {
  const Options& options = sources.options;
  FaceViews seen =
      find_face_views(mesh, sources.views, sources.images, options.visibility,
                      sources.context.stage("Views of faces"), {budget, options.image_bytes});
  return_freed_memory();
  if (options.take_views) options.take_views(mesh, seen);
  report.outliers = remove_outliers(seen, options.outlier_threshold);
  require_choice(seen, budget);
  return choose_views(seen, pairs, options.labels);
}

std::vector<std::uint32_t> label_by_tiles(const Mesh& mesh, std::span<const FacePair> pairs,
                                          const FaceTiles& tiles, const Sources& sources,
                                          const MemoryBudget& budget, Report& report) {
  const auto tree = budget.reserve(TileLabels::bytes(mesh) + bytes_of_surroundings(mesh),
                                   fmt::format("a tree of {} faces", mesh.faces.size()));
  const Surroundings whole(mesh);
  TileLabels labels(mesh, pairs, tiles);
  for (std::size_t tile = 0; tile < tiles.count(); ++tile) {
    labels.label(tile, whole, sources, sources.less_by_tiles(budget), report);
    return_freed_memory();
  }
  return labels.take();
}

}  // namespace

MemoryBudget Sources::less_by_tiles(const MemoryBudget& budget) const {
  return budget.with_advice("; a larger " + setting("tiles") + " needs less memory");
}

std::vector<std::uint32_t> label_faces(const Mesh& mesh, std::span<const FacePair> pairs,
                                       const FaceTiles& tiles, const Sources& sources,
                                       const MemoryBudget& budget, Report& report) {
  std::vector<std::uint32_t> labels =
      tiles.count() == 1
          ? label_in_one_piece(mesh, pairs, sources, sources.less_by_tiles(budget), report)
          : label_by_tiles(mesh, pairs, tiles, sources, budget, report);
  if (std::ranges::all_of(labels, [](std::uint32_t label) { return label == kNoView; }))
    fail("no view sees a face of the mesh");
  return labels;
}

}  // namespace axial::texture
