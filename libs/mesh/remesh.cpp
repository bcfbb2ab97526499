// SPDX-License-Identifier: GPL-3.0-or-later
// Isotropic remeshing after Botsch and Kobbelt, "A remeshing approach to multiresolution modeling",
// SGP 2004: long edges are split, short edges are collapsed, edges are flipped towards vertices of
// six edges, vertices move in the plane of the surface, and go back to the first surface.
//
// CGAL 5.5.1 has the same steps, but its relaxation reads outside of its arrays at a vertex whose
// faces have no area, and its collapse does not end at some borders. Meshes from clouds have such
// places.
#include <CGAL/boost/graph/Euler_operations.h>

#include <Eigen/Geometry>
#include <array>
#include <queue>
#include <tuple>
#include <vector>

#include "base/parallel.h"
#include "geometry/surface.h"
#include "private/halfedge_mesh.h"

namespace axial::mesh {
namespace {

using Vertex = HalfedgeMesh::Vertex_index;
using Half = HalfedgeMesh::Halfedge_index;
using Edge = HalfedgeMesh::Edge_index;

// Lengths, relative to the wanted one, from which edges are split, and below which they are
// collapsed: then neither step makes an edge for the other.
constexpr double kLong = 4.0 / 3, kShort = 4.0 / 5;

// Twice the area of a face, times its unit normal.
Eigen::Vector3d area_vector(const HalfedgeMesh& mesh, HalfedgeMesh::Face_index face) {
  const auto half = mesh.halfedge(face);
  const Eigen::Vector3d a = position(mesh, mesh.source(half)),
                        b = position(mesh, mesh.target(half)),
                        c = position(mesh, mesh.target(mesh.next(half)));
  return (b - a).cross(c - a);
}

double length_of(const HalfedgeMesh& mesh, Edge edge) {
  return (position(mesh, mesh.vertex(edge, 0)) - position(mesh, mesh.vertex(edge, 1))).norm();
}

void place(HalfedgeMesh& mesh, Vertex vertex, const Eigen::Vector3d& to) {
  mesh.point(vertex) = {to.x(), to.y(), to.z()};
}

// The area vectors of the faces around a vertex.
std::vector<Eigen::Vector3d> vectors_around(const HalfedgeMesh& mesh, Vertex vertex) {
  std::vector<Eigen::Vector3d> vectors;
  for (const auto face : mesh.faces_around_target(mesh.halfedge(vertex)))
    if (face != HalfedgeMesh::null_face()) vectors.push_back(area_vector(mesh, face));
  return vectors;
}

// True if a face with area would turn over or lose its area.
bool is_turned(const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
  return !before.isZero(0) && !(before.dot(after) > 0);
}

// Edges in the order of their lengths.
class EdgeQueue {
 public:
  explicit EdgeQueue(double sign) : sign_(sign) {}  // 1: the longest first, -1: the shortest

  void push(const HalfedgeMesh& mesh, Edge edge) {
    queue_.emplace(sign_ * length_of(mesh, edge), edge);
  }
  // The next edge that has the length with which it was pushed; an invalid edge if there is none.
  Edge pop(const HalfedgeMesh& mesh) {
    while (!queue_.empty()) {
      const auto [key, edge] = queue_.top();
      queue_.pop();
      if (!mesh.is_removed(edge) && sign_ * length_of(mesh, edge) == key) return edge;
    }
    return {};
  }

 private:
  double sign_;
  std::priority_queue<std::pair<double, Edge>> queue_;
};

// Whether the faces at both sides of an edge have the same corners, as the two sides of a triangle
// whose border was closed. A vertex in the edge would have two edges to the third corner.
bool is_fold(const HalfedgeMesh& mesh, Edge edge) {
  const Half half = mesh.halfedge(edge), back = mesh.opposite(half);
  return !mesh.is_border(edge) && mesh.target(mesh.next(half)) == mesh.target(mesh.next(back));
}

void split_long_edges(HalfedgeMesh& mesh, double longest) {
  EdgeQueue queue(1);
  const auto push = [&](Edge edge) {
    if (length_of(mesh, edge) > longest && !is_fold(mesh, edge)) queue.push(mesh, edge);
  };
  for (const Edge edge : mesh.edges()) push(edge);
  for (Edge edge = queue.pop(mesh); edge.is_valid(); edge = queue.pop(mesh)) {
    const Half half = mesh.halfedge(edge);
    const Eigen::Vector3d middle =
        0.5 * (position(mesh, mesh.source(half)) + position(mesh, mesh.target(half)));
    const Half first = CGAL::Euler::split_edge(half, mesh);  // ends at the new vertex
    place(mesh, mesh.target(first), middle);
    push(mesh.edge(first));
    push(mesh.edge(half));
    if (!mesh.is_border(first))
      push(mesh.edge(CGAL::Euler::split_face(first, mesh.next(half), mesh)));
    const Half back = mesh.opposite(first);
    if (!mesh.is_border(back))
      push(mesh.edge(CGAL::Euler::split_face(mesh.prev(back), mesh.next(back), mesh)));
  }
}

// The cosine of the angle at a vertex of the border: -1 where the border is straight.
double cosine_at_border(const HalfedgeMesh& mesh, Vertex vertex) {
  std::vector<Eigen::Vector3d> ways;
  for (const auto half : mesh.halfedges_around_target(mesh.halfedge(vertex)))
    if (mesh.is_border(half) || mesh.is_border(mesh.opposite(half)))
      ways.push_back((position(mesh, mesh.source(half)) - position(mesh, vertex)).normalized());
  return ways.size() == 2 ? ways[0].dot(ways[1]) : 1;
}

// Where the two ends of an edge would meet.
Eigen::Vector3d meeting_place(const HalfedgeMesh& mesh, Edge edge) {
  const Vertex a = mesh.vertex(edge, 0), b = mesh.vertex(edge, 1);
  const bool at_border = mesh.is_border(a), b_at_border = mesh.is_border(b);
  if (at_border && b_at_border)  // corners of the border stay
    return position(mesh, cosine_at_border(mesh, a) >= cosine_at_border(mesh, b) ? a : b);
  if (at_border || b_at_border) return position(mesh, at_border ? a : b);
  return 0.5 * (position(mesh, a) + position(mesh, b));
}

// Whether the faces around `vertex` keep their sides, and its edges are not too long, if it and
// `other` move to `to`.
bool allows_move(const HalfedgeMesh& mesh, Vertex vertex, Vertex other, const Eigen::Vector3d& to,
                 double longest) {
  for (const Half half : mesh.halfedges_around_target(mesh.halfedge(vertex))) {
    if (mesh.source(half) == other) continue;
    if ((position(mesh, mesh.source(half)) - to).norm() > longest) return false;
    if (mesh.is_border(half)) continue;
    const Vertex next = mesh.target(mesh.next(half));
    if (next == other) continue;
    const Eigen::Vector3d from = position(mesh, mesh.source(half));
    const Eigen::Vector3d after = (to - from).cross(position(mesh, next) - from);
    if (is_turned(area_vector(mesh, mesh.face(half)), after)) return false;
  }
  return true;
}

// A face that would hang on the mesh by one edge or by none.
bool leaves_spike(const HalfedgeMesh& mesh, Half half) {
  if (mesh.is_border(half)) return false;
  const bool next = mesh.is_border(mesh.opposite(mesh.next(half)));
  const bool before = mesh.is_border(mesh.opposite(mesh.prev(half)));
  return next && before;
}

bool may_collapse(const HalfedgeMesh& mesh, Edge edge, const Eigen::Vector3d& to, double longest) {
  const Half half = mesh.halfedge(edge), back = mesh.opposite(half);
  const Vertex a = mesh.source(half), b = mesh.target(half);
  if (mesh.is_border(a) && mesh.is_border(b) && !mesh.is_border(edge)) return false;
  return !is_fold(mesh, edge) && !leaves_spike(mesh, half) && !leaves_spike(mesh, back) &&
         CGAL::Euler::does_satisfy_link_condition(edge, mesh) &&
         allows_move(mesh, a, b, to, longest) && allows_move(mesh, b, a, to, longest);
}

void collapse_short_edges(HalfedgeMesh& mesh, double shortest, double longest) {
  EdgeQueue queue(-1);
  for (const Edge edge : mesh.edges())
    if (length_of(mesh, edge) < shortest) queue.push(mesh, edge);
  for (Edge edge = queue.pop(mesh); edge.is_valid(); edge = queue.pop(mesh)) {
    const Eigen::Vector3d to = meeting_place(mesh, edge);
    if (!may_collapse(mesh, edge, to, longest)) continue;
    const Vertex kept = CGAL::Euler::collapse_edge(edge, mesh);
    place(mesh, kept, to);
    for (const Half half : mesh.halfedges_around_target(mesh.halfedge(kept)))
      if (length_of(mesh, mesh.edge(half)) < shortest) queue.push(mesh, mesh.edge(half));
  }
}

// By how much the number of edges of a vertex is off after `change` more edges.
int valence_error(const HalfedgeMesh& mesh, Vertex vertex, int change) {
  const int wanted = mesh.is_border(vertex) ? 4 : 6;
  return std::abs(static_cast<int>(mesh.degree(vertex)) + change - wanted);
}

// Whether the new faces of a flipped edge lie like the old ones. `half`: inside the mesh.
bool may_flip(const HalfedgeMesh& mesh, Half half) {
  constexpr double kEdge = 0.5;  // cosine of the angle from which on an edge of the surface stays
  const Half back = mesh.opposite(half);
  const Vertex a = mesh.source(half), b = mesh.target(half);
  const Vertex c = mesh.target(mesh.next(half)), d = mesh.target(mesh.next(back));
  if (c == d || mesh.degree(a) < 4 || mesh.degree(b) < 4 || mesh.halfedge(c, d).is_valid())
    return false;
  const Eigen::Vector3d left = area_vector(mesh, mesh.face(half)),
                        right = area_vector(mesh, mesh.face(back)), both = left + right;
  if (left.dot(right) < kEdge * left.norm() * right.norm()) return false;
  const Eigen::Vector3d from = position(mesh, c), way = position(mesh, d) - from;
  const Eigen::Vector3d at_a = (position(mesh, a) - from).cross(way),
                        at_b = way.cross(position(mesh, b) - from);
  if (!(at_a.dot(both) > 0 && at_b.dot(both) > 0)) return false;
  if (at_a.dot(at_b) < kEdge * at_a.norm() * at_b.norm()) return false;
  const double before = std::min(left.norm(), right.norm()),
               after = std::min(at_a.norm(), at_b.norm());
  constexpr double kFlat = 1e-3;  // area vector of a flat face, over the square of its edge
  if (before < kFlat * (position(mesh, a) - position(mesh, b)).squaredNorm()) return after > before;
  return valence_error(mesh, a, -1) + valence_error(mesh, b, -1) + valence_error(mesh, c, 1) +
             valence_error(mesh, d, 1) <
         valence_error(mesh, a, 0) + valence_error(mesh, b, 0) + valence_error(mesh, c, 0) +
             valence_error(mesh, d, 0);
}

void flip_edges(HalfedgeMesh& mesh) {
  for (const Edge edge : mesh.edges())
    if (!mesh.is_border(edge) && may_flip(mesh, mesh.halfedge(edge)))
      CGAL::Euler::flip_edge(mesh.halfedge(edge), mesh);
}

// The place to which a vertex at the border moves along the border: half of the way to the mean of
// its neighbours there. At a corner of the border the vertex stays.
Eigen::Vector3d relaxed_at_border(const HalfedgeMesh& mesh, Vertex vertex) {
  constexpr double kStraight = -0.5;  // cosine of the smallest angle at which the vertex moves
  const Eigen::Vector3d at = position(mesh, vertex);
  if (cosine_at_border(mesh, vertex) > kStraight) return at;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto half : mesh.halfedges_around_target(mesh.halfedge(vertex)))
    if (mesh.is_border(half) || mesh.is_border(mesh.opposite(half)))
      sum += position(mesh, mesh.source(half));
  return 0.5 * at + 0.25 * sum;
}

// The place to which a vertex moves: in the plane of the surface to the mean of its neighbours.
Eigen::Vector3d relaxed(const HalfedgeMesh& mesh, Vertex vertex) {
  if (mesh.is_border(vertex)) return relaxed_at_border(mesh, vertex);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vector : vectors_around(mesh, vertex)) normal += vector;
  normal.normalize();  // zero stays zero
  const Eigen::Vector3d mean = mean_of_neighbours(mesh, vertex);
  return mean + normal.dot(position(mesh, vertex) - mean) * normal;
}

// Moves a vertex towards `to`, not so far that a face turns over or loses its area. Faces that have
// no area do not limit the move.
void move_without_flips(HalfedgeMesh& mesh, Vertex vertex, const Eigen::Vector3d& to) {
  constexpr int kHalvings = 5;
  const Eigen::Vector3d from = position(mesh, vertex);
  const std::vector<Eigen::Vector3d> before = vectors_around(mesh, vertex);
  double part = 1;
  for (int i = 0; i < kHalvings; ++i, part /= 2) {
    place(mesh, vertex, from + part * (to - from));
    const std::vector<Eigen::Vector3d> after = vectors_around(mesh, vertex);
    bool turned = false;
    for (std::size_t k = 0; k < before.size(); ++k)
      turned = turned || is_turned(before[k], after[k]);
    if (!turned) return;
  }
  place(mesh, vertex, from);
}

void relax(HalfedgeMesh& mesh) {
  std::vector<std::pair<Vertex, Eigen::Vector3d>> moves;
  for (const Vertex vertex : mesh.vertices())
    if (!mesh.is_isolated(vertex)) moves.emplace_back(vertex, relaxed(mesh, vertex));
  for (const auto& [vertex, to] : moves) move_without_flips(mesh, vertex, to);
}

void project(HalfedgeMesh& mesh, const geometry::Surface& surface) {
  const std::vector<Vertex> vertices(mesh.vertices().begin(), mesh.vertices().end());
  parallel_for(
      vertices.size(),
      [&](std::size_t i) {
        place(mesh, vertices[i], surface.closest(position(mesh, vertices[i])).point);
      },
      kPointGrain);
}

}  // namespace

void remesh(HalfedgeMesh& mesh, double edge_length) {
  constexpr int kRounds = 3;
  HalfedgeMesh copy = mesh;
  const geometry::Surface surface(from_halfedges(copy));
  for (int round = 0; round < kRounds; ++round) {
    split_long_edges(mesh, kLong * edge_length);
    collapse_short_edges(mesh, kShort * edge_length, kLong * edge_length);
    mesh.collect_garbage();
    flip_edges(mesh);
    relax(mesh);
    project(mesh, surface);
  }
  for (const Vertex vertex : mesh.vertices()) move_to(mesh, vertex, position(mesh, vertex));
}

}  // namespace axial::mesh
