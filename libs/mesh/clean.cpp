// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/clean.h"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "private/halfedge_mesh.h"

namespace axial::mesh {
namespace pmp = CGAL::Polygon_mesh_processing;
namespace {

double mean_edge_length(const HalfedgeMesh& mesh) {
  double sum = 0;
  for (const auto edge : mesh.edges()) sum += pmp::edge_length(mesh.halfedge(edge), mesh);
  return sum / static_cast<double>(mesh.number_of_edges());
}

using Components = HalfedgeMesh::Property_map<HalfedgeMesh::Face_index, std::size_t>;

Components find_components(HalfedgeMesh& mesh, const std::string& name) {
  Components component =
      mesh.add_property_map<HalfedgeMesh::Face_index, std::size_t>(name, 0).first;
  pmp::connected_components(mesh, component);
  return component;
}

// The diagonals of the components' bounding boxes.
std::vector<double> sizes_of(const HalfedgeMesh& mesh, const Components& component) {
  std::vector<CGAL::Bbox_3> boxes;
  for (const auto face : mesh.faces()) {
    boxes.resize(std::max(boxes.size(), component[face] + 1));
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      boxes[component[face]] += mesh.point(vertex).bbox();
  }
  std::vector<double> sizes;
  sizes.reserve(boxes.size());
  for (const CGAL::Bbox_3& box : boxes)
    sizes.push_back(Eigen::Vector3d(box.x_span(), box.y_span(), box.z_span()).norm());
  return sizes;
}

// Removes the components for which is_small(component, size) holds. Returns their number.
std::size_t remove_components(HalfedgeMesh& mesh, Components& component,
                              const std::vector<double>& sizes, const auto& is_small) {
  std::vector<std::size_t> small;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (is_small(i, sizes[i])) small.push_back(i);
  pmp::remove_connected_components(mesh, small, component);
  mesh.remove_property_map(component);
  mesh.collect_garbage();
  return small.size();
}

// Removes components smaller than `limit`. Returns their number.
std::size_t remove_small_components(HalfedgeMesh& mesh, double limit) {
  if (limit == 0 || mesh.number_of_faces() == 0) return 0;
  Components component = find_components(mesh, "f:component");
  return remove_components(mesh, component, sizes_of(mesh, component),
                           [&](std::size_t, double size) { return size < limit; });
}

// Removes components smaller than `factor` mean edge lengths that were parts of larger components
// when `before` was found. Returns their number.
std::size_t remove_cut_off_components(HalfedgeMesh& mesh, const Components& before, double factor) {
  if (factor == 0 || mesh.number_of_faces() == 0) return 0;
  const double limit = factor * mean_edge_length(mesh);
  Components component = find_components(mesh, "f:component");
  const std::vector<double> sizes = sizes_of(mesh, component);
  std::vector<std::size_t> origins(sizes.size());
  for (const auto face : mesh.faces()) origins[component[face]] = before[face];
  std::map<std::size_t, std::size_t> largest;  // component of each origin
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const auto entry = largest.emplace(origins[i], i).first;
    if (sizes[i] > sizes[entry->second]) entry->second = i;
  }
  return remove_components(mesh, component, sizes, [&](std::size_t i, double size) {
    return size < limit && largest[origins[i]] != i;
  });
}

// Moves the vertices inside the mesh by `part` of the way to the mean of their neighbours.
void move_to_means(HalfedgeMesh& mesh, double part) {
  std::vector<Eigen::Vector3d> moved(mesh.number_of_vertices());
  for (const auto vertex : mesh.vertices()) {
    moved[vertex.idx()] = position(mesh, vertex);
    if (mesh.is_isolated(vertex) || mesh.is_border(vertex)) continue;
    moved[vertex.idx()] += part * (mean_of_neighbours(mesh, vertex) - moved[vertex.idx()]);
  }
  for (const auto vertex : mesh.vertices()) move_to(mesh, vertex, moved[vertex.idx()]);
}

// Taubin, "A signal processing approach to fair surface design", SIGGRAPH 1995: a step towards the
// means and a slightly longer step back damp noise and keep curved surfaces in place.
void smooth(HalfedgeMesh& mesh, unsigned steps) {
  for (unsigned i = 0; i < steps; ++i) {
    move_to_means(mesh, 0.5);
    move_to_means(mesh, -0.53);
  }
}

void mend(HalfedgeMesh& mesh, const CleanOptions& options, CleanReport& report) {
  if (options.spikes) report.removed_spikes += remove_spikes(mesh);
  mesh.collect_garbage();
  report.closed_holes += close_holes(mesh, options.close_holes);
}

// Remeshing does not end for a mesh without area. Long thin faces have a small area, but their
// edges are split, too.
void check_edge_length(const HalfedgeMesh& mesh, double length) {
  constexpr double kMostFaces = 1 << 28;
  const double equilateral = 0.433 * length * length;  // area
  const double area = pmp::area(mesh);
  const double edges = mean_edge_length(mesh) * static_cast<double>(mesh.number_of_edges());
  if (area <= 0) fail("the mesh has no area, so that it cannot be remeshed");
  if (area > kMostFaces * equilateral || edges > kMostFaces * length)
    fail("remeshing to edges of {} would make more than {} faces", length, kMostFaces);
}

std::size_t faces_to_keep(const HalfedgeMesh& mesh, const CleanOptions& options) {
  if (options.target_faces > 0) return options.target_faces;
  return static_cast<std::size_t>(options.decimate * static_cast<double>(mesh.number_of_faces()));
}

}  // namespace

std::size_t close_holes(HalfedgeMesh& mesh, std::size_t most, const VertexFilter& open) {
  if (most == 0) return 0;
  std::vector<HalfedgeMesh::Halfedge_index> cycles;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(cycles));
  std::size_t closed = 0;
  for (const auto cycle : cycles) {
    std::size_t edges = 0;
    bool stays_open = false;
    for (const auto half : mesh.halfedges_around_face(cycle)) {
      ++edges;
      stays_open = stays_open || (open && open(mesh.target(half)));
    }
    if (edges > most || stays_open) continue;
    std::vector<HalfedgeMesh::Face_index> patch;
    pmp::triangulate_hole(mesh, cycle, std::back_inserter(patch));
    closed += patch.empty() ? 0 : 1;
  }
  return closed;
}

std::uint64_t bytes_to_clean(std::uint64_t vertices) {
  // Measured: CGAL's mesh with its properties, and the boxes of the search for intersections.
  return vertices * 1100;
}

Mesh clean(const Mesh& mesh, const CleanOptions& options, CleanReport* report) {
  if (mesh.faces.empty()) fail("the mesh has no faces");
  CleanReport own;
  CleanReport& result = report ? *report : own;
  result = {};
  HalfedgeMesh surface = to_halfedges(mesh);
  if (surface.number_of_faces() == 0) fail("all faces of the mesh name a vertex twice");
  const double spurious = options.spurious * mean_edge_length(surface);
  result.removed_components = remove_small_components(surface, spurious);
  if (const std::size_t faces = faces_to_keep(surface, options); faces < surface.number_of_faces())
    decimate(surface, faces);
  mend(surface, options, result);
  separate_copies(surface);
  smooth(surface, options.smooth);
  if (options.edge_length > 0 && surface.number_of_faces() > 0) {
    check_edge_length(surface, options.edge_length);
    remesh(surface, options.edge_length);
    mend(surface, options, result);
  }
  const Components before = find_components(surface, "f:before");
  result.removed_intersections = untangle(surface);
  result.removed_components += remove_cut_off_components(surface, before, options.cut_off);
  result.removed_components += remove_small_components(surface, spurious);
  if (surface.number_of_faces() == 0 && !options.may_be_empty)
    fail(
        "no face of the mesh is left: all pieces are smaller than the limit for spurious pieces, "
        "or their faces intersect each other");
  return from_halfedges(surface);
}

}  // namespace axial::mesh
