// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/faces/split_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/edges.h"
#include "geometry/posed_camera.h"
#include "scene/camera_model.h"

namespace axial::texture {
namespace {

using Corners = std::array<std::uint32_t, 3>;

// An edge, with a face on its left and one on its right. More faces are left out.
struct Edge {
  std::uint32_t from, to;
  std::array<std::uint32_t, 2> faces;
};

// The edges of a mesh, and the edge that begins at each corner of a face.
struct Edges {
  std::vector<Edge> list;
  std::vector<Corners> of_face;

  explicit Edges(const Mesh& mesh) : of_face(mesh.faces.size()) {
    const std::vector<geometry::Side> sides = geometry::sides_of(mesh.faces);
    list.reserve(sides.size());
    geometry::for_each_edge(sides, [&](std::span<const geometry::Side> edge) {
      for (const geometry::Side& side : edge)
        of_face[side.face][side.corner] = static_cast<std::uint32_t>(list.size());
      list.push_back({edge[0].low, edge[0].high, {edge.front().face, edge.back().face}});
    });
  }
};

// Whether the image of the edge is too far from linear in a view.
template <class Camera>
class EdgeTest {
 public:
  EdgeTest(const Camera& camera, const View& view, double tolerance)
      : camera_(camera),
        view_(view),
        tolerance_(tolerance),
        // For a pinhole, the error is at most focal / 4 times the square of the edge's length over
        // its distance. Refraction makes images larger by the index of water, and it and the lens
        // bend lines: ten times as much is surely enough.
        bound_(10 * std::max(view.camera.lens.fx, view.camera.lens.fy) / 4) {}

  bool too_long(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    const Eigen::Vector3d middle = (a + b) / 2;
    const double square = (middle - view_.pose.centre).squaredNorm();
    if (bound_ * (b - a).squaredNorm() < tolerance_ * square) return false;
    const auto from = image_of(a), to = image_of(b), between = image_of(middle);
    if (!from || !to || !between) return false;
    return ((*from + *to) / 2 - *between).norm() > tolerance_;
  }

 private:
  std::optional<Eigen::Vector2d> image_of(const Eigen::Vector3d& point) const {
    const auto image = camera_.project(view_.pose.to_camera(point));
    if (!image.visible || !geometry::is_in_image(view_.camera, image.pixel, -0.5)) return {};
    return image.pixel;
  }

  const Camera& camera_;
  const View& view_;
  double tolerance_, bound_;
};

std::vector<char> long_edges(const Mesh& mesh, const Edges& edges, std::span<const View> views,
                             double tolerance) {
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces)
    normals.push_back(
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]));
  std::vector<char> found(edges.list.size(), 0);
  for (const View& view : views)
    std::visit(
        [&](const auto& camera) {
          const EdgeTest test(camera, view, tolerance);
          parallel_for(
              edges.list.size(),
              [&](std::size_t i) {
                if (found[i]) return;
                const Edge& edge = edges.list[i];
                const Eigen::Vector3d a = mesh.vertices[edge.from].cast<double>();
                const Eigen::Vector3d to_camera = view.pose.centre - a;
                const auto faces_it = [&](std::uint32_t face) {
                  return normals[face].cast<double>().dot(to_camera) > 0;
                };
                if (!faces_it(edge.faces[0]) && !faces_it(edge.faces[1])) return;
                found[i] = test.too_long(a, mesh.vertices[edge.to].cast<double>());
              },
              kPointGrain);
        },
        make_camera<double>(view.camera));
  return found;
}

// The vertex in the middle of each marked edge; other entries are not used.
std::vector<std::uint32_t> add_middles(const Edges& edges, std::span<const char> marked,
                                       Mesh& mesh) {
  std::vector<std::uint32_t> middle(edges.list.size(), 0);
  for (std::size_t i = 0; i < edges.list.size(); ++i) {
    if (!marked[i]) continue;
    const auto [from, to, faces] = edges.list[i];
    middle[i] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back((mesh.vertices[from] + mesh.vertices[to]) / 2);
    if (mesh.colors.empty()) continue;
    Rgb color{};
    for (std::size_t c = 0; c < 3; ++c)
      color[c] = static_cast<std::uint8_t>((mesh.colors[from][c] + mesh.colors[to][c] + 1) / 2);
    mesh.colors.push_back(color);
  }
  return middle;
}

// Appends the parts of a face. `middle[k]` is the vertex in the edge that begins at corner k.
void append_parts(const Corners& face, const std::array<bool, 3>& marked, const Corners& middle,
                  std::vector<Corners>& faces) {
  const auto count = std::count(marked.begin(), marked.end(), true);
  if (count == 0) return faces.push_back(face);
  if (count == 3) {
    for (std::size_t k = 0; k < 3; ++k) faces.push_back({face[k], middle[k], middle[(k + 2) % 3]});
    return faces.push_back(middle);
  }
  // Begin at a marked edge; of two, at the second in the order of the corners around the face.
  std::size_t k = 0;
  while (!(marked[k] && (count == 1 || marked[(k + 2) % 3]))) ++k;
  const std::uint32_t a = face[k], b = face[(k + 1) % 3], c = face[(k + 2) % 3], m = middle[k];
  faces.push_back({m, b, c});
  if (count == 1) return faces.push_back({a, m, c});
  const std::uint32_t n = middle[(k + 2) % 3];  // between c and a
  faces.push_back({m, c, n});
  faces.push_back({a, m, n});
}

void split_marked(const Edges& edges, std::span<const char> marked, Mesh& mesh) {
  const std::vector<std::uint32_t> middle = add_middles(edges, marked, mesh);
  std::vector<Corners> faces;
  std::vector<std::uint8_t> unseen;
  faces.reserve(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Corners& e = edges.of_face[f];
    append_parts(mesh.faces[f], {marked[e[0]] != 0, marked[e[1]] != 0, marked[e[2]] != 0},
                 {middle[e[0]], middle[e[1]], middle[e[2]]}, faces);
    if (!mesh.unseen.empty()) unseen.resize(faces.size(), mesh.unseen[f]);
  }
  mesh.faces = std::move(faces);
  mesh.unseen = std::move(unseen);
}

}  // namespace

std::uint64_t bytes_to_split(std::uint64_t faces, std::uint64_t split) {
  // Every edge of a face, once alone, and once with both of its faces. A mesh has at most as many
  // edges as corners, usually half as many. Then the edge at each corner, the normals, and a mark
  // and a vertex of each edge.
  const std::uint64_t edges = 3 * faces;
  const std::uint64_t listing = edges * (16 + sizeof(Edge) / 2) + faces * sizeof(Corners);
  const std::uint64_t testing =
      edges * sizeof(Edge) / 2 + faces * (sizeof(Corners) + sizeof(Eigen::Vector3f)) + edges;
  // Arrays that grow are in memory twice.
  const std::uint64_t parts = (faces + 2 * split) * 2 * sizeof(Corners);
  const std::uint64_t splitting = edges * (sizeof(Edge) / 2 + 1 + 4) + faces * sizeof(Corners) +
                                  parts + split * 2 * sizeof(Eigen::Vector3f);
  return std::max({listing, testing, splitting});
}

std::size_t split_faces(Mesh& mesh, std::span<const View> views, const SplitOptions& options,
                        const MemoryBudget& budget, const Context& context) {
  const std::size_t before = mesh.faces.size();
  constexpr int kMostRounds = 16;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::string work = fmt::format("splitting the {} faces of the mesh", mesh.faces.size());
    budget.require(bytes_to_split(mesh.faces.size(), 0), work);
    const Edges edges(mesh);
    const std::vector<char> marked = long_edges(mesh, edges, views, 0.75 * options.tolerance);
    const auto count = static_cast<std::size_t>(std::ranges::count(marked, 1));
    if (count == 0) break;
    if (mesh.faces.size() + 2 * count > options.max_faces) {
      context.warning("faces are not split further: {} faces, and {} edges to split",
                      mesh.faces.size(), count);
      break;
    }
    budget.require(bytes_to_split(mesh.faces.size(), count), work);
    split_marked(edges, marked, mesh);
  }
  return mesh.faces.size() - before;
}

}  // namespace axial::texture
