// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/unseen.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "base/error.h"
#include "base/order_statistics.h"
#include "base/parallel.h"
#include "geometry/lists.h"
#include "mesh/point_distances.h"
#include "scene/marked_faces.h"

namespace axial::mesh {
namespace {

constexpr std::uint32_t kNoNeighbour = std::numeric_limits<std::uint32_t>::max();

// The faces around the vertices and beside the faces of a manifold, oriented mesh.
class FaceGraph {
 public:
  explicit FaceGraph(const Mesh& mesh)
      : mesh_(mesh), around_(geometry::faces_of_vertices(mesh)), beside_(mesh.faces.size()) {
    parallel_for(
        beside_.size(),
        [&](std::size_t f) {
          for (std::size_t k = 0; k < 3; ++k)
            beside_[f][k] = face_of_edge(mesh.faces[f][(k + 1) % 3], mesh.faces[f][k]);
        },
        kPointGrain);
  }

  // The faces with the corner `vertex`, ascending.
  std::span<const std::uint32_t> around(std::uint32_t vertex) const { return around_.of(vertex); }
  // The face at the other side of the edge that begins at corner `k`, or kNoNeighbour.
  std::uint32_t beside(std::uint32_t face, std::size_t k) const { return beside_[face][k]; }
  std::size_t corner_at(std::uint32_t face, std::uint32_t vertex) const {
    const auto& corners = mesh_.faces[face];
    return static_cast<std::size_t>(std::ranges::find(corners, vertex) - corners.begin());
  }

  static std::uint64_t bytes(const Mesh& mesh) {
    return mesh.faces.size() * 6 * sizeof(std::uint32_t) +
           mesh.vertices.size() * 2 * sizeof(std::uint32_t);
  }

 private:
  std::uint32_t face_of_edge(std::uint32_t from, std::uint32_t to) const {
    for (const std::uint32_t f : around(from))
      if (mesh_.faces[f][(corner_at(f, from) + 1) % 3] == to) return f;
    return kNoNeighbour;
  }

  const Mesh& mesh_;
  geometry::Lists<> around_;
  std::vector<std::array<std::uint32_t, 3>> beside_;
};

// Calls take(component) with each connected set of the faces that `member` chooses.
template <class Member, class Take>
void for_each_component(const FaceGraph& graph, std::size_t faces, const Member& member,
                        const Take& take) {
  std::vector<bool> found(faces, false);
  std::vector<std::uint32_t> component;
  for (std::uint32_t first = 0; first < faces; ++first) {
    if (found[first] || !member(first)) continue;
    component.assign(1, first);
    found[first] = true;
    for (std::size_t i = 0; i < component.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t next = graph.beside(component[i], k);
        if (next == kNoNeighbour || found[next] || !member(next)) continue;
        found[next] = true;
        component.push_back(next);
      }
    take(component);
  }
}

float longest_edge(const Mesh& mesh, std::size_t face) {
  const auto& [a, b, c] = mesh.faces[face];
  const std::vector<Eigen::Vector3f>& at = mesh.vertices;
  return std::max({(at[a] - at[b]).norm(), (at[b] - at[c]).norm(), (at[c] - at[a]).norm()});
}

float median_longest_edge(const Mesh& mesh) {
  std::vector<float> lengths;
  lengths.reserve(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) lengths.push_back(longest_edge(mesh, f));
  return upper_median(std::move(lengths));
}

// The least cosine at which two cameras must see a face that points do not prove.
constexpr float kLargestCosine = 0.5f;

// The same for a face whose longest edge is `ratio` times the median one, if points are not known.
float least_cosine(float ratio) {
  constexpr float kFrom = 3.0f, kSlope = 0.2f, kMost = 0.4f;
  return std::clamp(kSlope * (ratio - kFrom), 0.0f, kMost);
}

// The cosine at which two cameras must see each face: more than this number for the first kind of
// unseen faces and at least this number for the second kind; below 0: nothing is necessary.
struct LeastCosines {
  std::vector<float> first, second;
};

LeastCosines without_second_kind(const Mesh& mesh) {
  const std::vector<float> zero(mesh.faces.size(), 0.0f);
  return {zero, zero};
}

// `median`: of the longest edges.
LeastCosines by_sizes(const Mesh& mesh, float median) {
  LeastCosines least = without_second_kind(mesh);
  for (std::size_t f = 0; f < least.second.size(); ++f)
    least.second[f] = least_cosine(longest_edge(mesh, f) / median);
  return least;
}

LeastCosines least_cosines(const Mesh& mesh, float median_edge, const UnseenOptions& options,
                           const Context& context) {
  constexpr float kFar = 9.0f, kFirst = 0.25f, kProven = -2.0f;
  if (!options.sizes_tell) return without_second_kind(mesh);
  if (options.points.empty()) return by_sizes(mesh, median_edge);
  const std::vector<float> distances = distances_to_points(mesh, options.points);
  const float middle = upper_median(distances);
  if (middle > median_edge) {
    context.info("the cloud is too sparse for this mesh to tell which faces were measured");
    return by_sizes(mesh, median_edge);
  }
  const float limit = kFar * middle;
  LeastCosines least = without_second_kind(mesh);
  for (std::size_t f = 0; f < distances.size(); ++f) {
    const bool is_far = distances[f] > limit;
    least.first[f] = is_far ? kFirst : kProven;
    least.second[f] = is_far ? kLargestCosine : kProven;
  }
  return least;
}

// Clears the marks of `unseen` in connected sets of marked faces without a face that `certain`
// marks.
void keep_without_certain(const FaceGraph& graph, std::span<const std::uint8_t> certain,
                          std::vector<std::uint8_t>& unseen) {
  std::vector<std::uint8_t> left(unseen.size(), 0);
  for_each_component(
      graph, unseen.size(), [&](std::uint32_t f) { return unseen[f] == 1; },
      [&](std::span<const std::uint32_t> component) {
        if (std::ranges::any_of(component, [&](std::uint32_t f) { return certain[f] == 1; }))
          for (const std::uint32_t f : component) left[f] = 1;
      });
  unseen = std::move(left);
}

// Clears the marks of small sets of faces inside the seen surface. `limit`: of the diagonals of
// their bounding boxes.
void keep_small_holes(const Mesh& mesh, const FaceGraph& graph, float limit,
                      std::vector<std::uint8_t>& unseen) {
  std::vector<std::uint8_t> kept = unseen;
  for_each_component(
      graph, unseen.size(), [&](std::uint32_t f) { return unseen[f] == 1; },
      [&](std::span<const std::uint32_t> component) {
        Eigen::AlignedBox3f box;
        bool is_open = false;  // at the border of the mesh
        for (const std::uint32_t f : component)
          for (std::size_t k = 0; k < 3; ++k) {
            box.extend(mesh.vertices[mesh.faces[f][k]]);
            is_open = is_open || graph.beside(f, k) == kNoNeighbour;
          }
        if (is_open || box.diagonal().norm() > limit) return;
        for (const std::uint32_t f : component) kept[f] = 0;
      });
  unseen = std::move(kept);
}

// Removes faces of a mesh, and others that may not stay without them.
class Removal {
 public:
  Removal(const Mesh& mesh, std::vector<std::uint8_t> gone)
      : mesh_(mesh), graph_(mesh), gone_(std::move(gone)) {}

  void keep_manifold() {
    while (remove_spikes() + remove_small_fans() > 0) {
    }
  }

  // Returns the number of pieces.
  std::size_t remove_pieces(double factor) {
    const std::vector<std::uint32_t> origins = components([](std::uint32_t) { return true; });
    const std::vector<std::uint32_t> parts = components([&](std::uint32_t f) { return !gone_[f]; });
    const std::vector<float> sizes = sizes_of(parts);
    std::vector<std::uint32_t> largest(mesh_.faces.size(), kNoNeighbour);  // part of each origin
    std::vector<std::uint32_t> origin_of(sizes.size());
    for (std::size_t f = 0; f < parts.size(); ++f)
      if (parts[f] != kNoNeighbour) origin_of[parts[f]] = origins[f];
    for (std::uint32_t p = 0; p < sizes.size(); ++p) {
      std::uint32_t& best = largest[origin_of[p]];
      if (best == kNoNeighbour || sizes[p] > sizes[best]) best = p;
    }
    const float limit = static_cast<float>(factor) * mean_edge();
    std::vector<bool> small(sizes.size());
    for (std::uint32_t p = 0; p < sizes.size(); ++p)
      small[p] = sizes[p] < limit && largest[origin_of[p]] != p;
    for (std::size_t f = 0; f < parts.size(); ++f)
      if (parts[f] != kNoNeighbour && small[parts[f]]) gone_[f] = 1;
    return static_cast<std::size_t>(std::ranges::count(small, true));
  }

  std::size_t removed() const {
    return static_cast<std::size_t>(std::ranges::count(gone_, std::uint8_t{1}));
  }

  // The mesh without the removed faces.
  Mesh rest() const {
    Mesh rest = mesh_;
    rest.unseen = gone_;
    remove_marked_faces(rest);
    return rest;
  }

 private:
  bool is_there(std::uint32_t face) const { return face != kNoNeighbour && !gone_[face]; }

  // Removes faces with a new border and at most one neighbour.
  std::size_t remove_spikes() {
    std::size_t removed = 0;
    for (std::uint32_t f = 0; f < gone_.size(); ++f) {
      if (gone_[f]) continue;
      int neighbours = 0;
      bool has_new_border = false;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t other = graph_.beside(f, k);
        neighbours += is_there(other);
        has_new_border = has_new_border || (other != kNoNeighbour && gone_[other]);
      }
      if (neighbours > 1 || !has_new_border) continue;
      gone_[f] = 1;
      ++removed;
    }
    return removed;
  }

  // The faces around a vertex that are still there, in sets that are connected by edges at the
  // vertex; empty if they are one set.
  std::vector<std::vector<std::uint32_t>> fans_at(std::uint32_t vertex) const {
    std::vector<std::vector<std::uint32_t>> fans;
    for (const std::uint32_t first : graph_.around(vertex)) {
      if (gone_[first] || is_there(graph_.beside(first, graph_.corner_at(first, vertex)))) continue;
      std::vector<std::uint32_t>& fan = fans.emplace_back();
      for (std::uint32_t f = first; is_there(f);
           f = graph_.beside(f, (graph_.corner_at(f, vertex) + 2) % 3))
        fan.push_back(f);
    }
    if (fans.size() == 1) fans.clear();
    return fans;
  }

  std::size_t remove_small_fans() {
    std::size_t removed = 0;
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
      const auto fans = fans_at(v);
      if (fans.empty()) continue;
      const auto kept = std::ranges::max_element(
          fans, {}, [](const std::vector<std::uint32_t>& fan) { return fan.size(); });
      for (auto fan = fans.begin(); fan != fans.end(); ++fan)
        for (const std::uint32_t f : *fan)
          if (fan != kept) gone_[f] = 1, ++removed;
    }
    return removed;
  }

  // The number of the component of each face, or kNoNeighbour for faces that are not a member.
  template <class Member>
  std::vector<std::uint32_t> components(const Member& member) const {
    std::vector<std::uint32_t> numbers(mesh_.faces.size(), kNoNeighbour);
    std::uint32_t count = 0;
    for_each_component(graph_, numbers.size(), member,
                       [&](std::span<const std::uint32_t> component) {
                         for (const std::uint32_t f : component) numbers[f] = count;
                         ++count;
                       });
    return numbers;
  }

  // The diagonals of the parts' bounding boxes.
  std::vector<float> sizes_of(const std::vector<std::uint32_t>& parts) const {
    std::vector<Eigen::AlignedBox3f> boxes;
    for (std::size_t f = 0; f < parts.size(); ++f) {
      if (parts[f] == kNoNeighbour) continue;
      if (parts[f] >= boxes.size()) boxes.resize(parts[f] + 1);
      for (const std::uint32_t v : mesh_.faces[f]) boxes[parts[f]].extend(mesh_.vertices[v]);
    }
    std::vector<float> sizes;
    sizes.reserve(boxes.size());
    for (const Eigen::AlignedBox3f& box : boxes) sizes.push_back(box.diagonal().norm());
    return sizes;
  }

  float mean_edge() const {
    double sum = 0, count = 0;
    for (std::size_t f = 0; f < gone_.size(); ++f)
      for (std::size_t k = 0; k < 3 && !gone_[f]; ++k, ++count)
        sum += static_cast<double>(
            (mesh_.vertices[mesh_.faces[f][k]] - mesh_.vertices[mesh_.faces[f][(k + 1) % 3]])
                .norm());
    return static_cast<float>(count > 0 ? sum / count : 0);
  }

  const Mesh& mesh_;
  FaceGraph graph_;
  std::vector<std::uint8_t> gone_;
};

// The share of the area in marked faces.
double marked_share(const Mesh& mesh) {
  double all = 0, marked = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    const Eigen::Vector3f& at = mesh.vertices[a];
    const auto area =
        static_cast<double>((mesh.vertices[b] - at).cross(mesh.vertices[c] - at).norm());
    all += area;
    if (mesh.unseen[f]) marked += area;
  }
  return all > 0 ? marked / all : 0;
}

}  // namespace

std::vector<std::uint8_t> unseen_faces(const Mesh& mesh,
                                       std::span<const geometry::PosedCamera> cameras,
                                       const UnseenOptions& options, const Context& context) {
  const std::vector<float> cosines =
      geometry::second_cosines(mesh, cameras, kLargestCosine, {}, context.stage("Looked"));
  const float median_edge = median_longest_edge(mesh);
  std::vector<std::uint8_t> certain(mesh.faces.size()), unseen(mesh.faces.size());
  {
    const LeastCosines least = least_cosines(mesh, median_edge, options, context);
    for (std::size_t f = 0; f < unseen.size(); ++f) {
      certain[f] = !(cosines[f] > least.first[f]);
      unseen[f] = certain[f] || cosines[f] < least.second[f];
    }
  }
  const FaceGraph graph(mesh);
  keep_without_certain(graph, certain, unseen);
  const float limit = static_cast<float>(options.small_holes) * median_edge;
  keep_small_holes(mesh, graph, limit, unseen);
  return unseen;
}

Mesh without_unseen(const Mesh& mesh, std::vector<std::uint8_t> unseen, double cut_off,
                    UnseenReport* report) {
  Removal removal(mesh, std::move(unseen));
  removal.keep_manifold();
  const std::size_t pieces = removal.remove_pieces(cut_off);
  if (report) *report = {removal.removed(), pieces};
  return removal.rest();
}

Mesh treat_unseen(Mesh mesh, std::span<const geometry::PosedCamera> cameras,
                  const UnseenOptions& options, const Context& context) {
  mesh.unseen = {};
  if (cameras.size() < 2) {
    context.warning("surface that no two cameras see is kept: the scene has {} cameras",
                    cameras.size());
    return mesh;
  }
  mesh.unseen = unseen_faces(mesh, cameras, options, context);
  const auto unseen = static_cast<std::size_t>(std::ranges::count(mesh.unseen, std::uint8_t{1}));
  const double share = 100 * marked_share(mesh);
  if (options.keep) {
    context.info("{} faces, {:.1f} % of the area, are marked as unseen: no two cameras see them",
                 unseen, share);
    return mesh;
  }
  if (unseen == mesh.faces.size()) fail("no two cameras see the front of a face of the mesh");
  UnseenReport report;
  Mesh rest = without_unseen(mesh, std::move(mesh.unseen), options.cut_off, &report);
  context.info(
      "{} faces removed: {}, {:.1f} % of the area, that no two cameras see, and others at their "
      "border; {} pieces were cut off",
      report.faces, unseen, share, report.pieces);
  return rest;
}

std::uint64_t bytes_of_unseen(const Mesh& mesh) {
  const std::uint64_t points = enough_points(mesh.faces.size()) * sizeof(Eigen::Vector3f);
  // The graph; the components before and after, the parts of the origins, marks; then the rest.
  const std::uint64_t rest = mesh.vertices.size() * 17 + mesh.faces.size() * 13;
  const std::uint64_t removing = FaceGraph::bytes(mesh) + mesh.faces.size() * 14 + rest;
  const std::uint64_t cosines = mesh.faces.size() * sizeof(float);
  const std::uint64_t proving = cosines + bytes_of_distances(mesh);
  return points + std::max({geometry::bytes_of_cosines(mesh), proving, removing});
}

}  // namespace axial::mesh
