// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary/cut_mesh.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "boundary/cut_faces.h"
#include "scene/marked_faces.h"

namespace axial::boundary {
namespace {

Eigen::AlignedBox2d extent_of(const Mesh& mesh, const Boundary& boundary) {
  Eigen::AlignedBox2d box;
  for (const auto& face : mesh.faces)
    for (const std::uint32_t vertex : face)
      box.extend(boundary.on_map(boundary.plan_of(mesh.vertices[vertex].cast<double>())));
  return box;
}

// Calls whole(face) or part(face, piece) in the order of the faces of the result.
template <class Whole, class Part>
void for_each_face(const CutFaces& cut, const Whole& whole, const Part& part) {
  for (std::size_t f = 0; f < cut.outside.size(); ++f) {
    if (cut.split_at[f] == CutFaces::kWhole)
      whole(f);
    else
      for (const Piece& piece : cut.splits[cut.split_at[f]]) part(f, piece);
  }
}

// One value for each face of the result, where a piece has the value of its face.
template <class T>
std::vector<T> inherited(const CutFaces& cut, const std::vector<T>& values) {
  std::vector<T> result;
  result.reserve(values.size());
  for_each_face(
      cut, [&](std::size_t f) { result.push_back(values[f]); },
      [&](std::size_t f, const Piece&) { result.push_back(values[f]); });
  return result;
}

std::vector<TexturedMesh::Corners> split_uv(const CutFaces& cut,
                                            const std::vector<TexturedMesh::Corners>& uv) {
  std::vector<TexturedMesh::Corners> result;
  result.reserve(uv.size());
  for_each_face(
      cut, [&](std::size_t f) { result.push_back(uv[f]); },
      [&](std::size_t f, const Piece& piece) {
        TexturedMesh::Corners corners;
        for (std::size_t k = 0; k < 3; ++k) {
          const Eigen::Vector3f w = piece.weights.col(static_cast<Eigen::Index>(k));
          // A face without colours has equal corners, and so have its pieces.
          corners[k] = uv[f][0] + w[1] * (uv[f][1] - uv[f][0]) + w[2] * (uv[f][2] - uv[f][0]);
        }
        result.push_back(corners);
      });
  return result;
}

// Splits the faces and marks them. Returns the number of faces outside.
std::size_t apply(const CutFaces& cut, Mesh& mesh) {
  if (mesh.unseen.empty()) mesh.unseen.resize(mesh.faces.size());
  std::vector<std::uint8_t> marks = inherited(cut, mesh.unseen);
  std::vector<std::array<std::uint32_t, 3>> faces;
  faces.reserve(marks.size());
  std::size_t outside = 0;
  const auto add = [&](const std::array<std::uint32_t, 3>& face, bool is_outside) {
    if (is_outside) marks[faces.size()] = kOutside;
    outside += is_outside ? 1 : 0;
    faces.push_back(face);
  };
  for_each_face(
      cut, [&](std::size_t f) { add(mesh.faces[f], cut.outside[f] != 0); },
      [&](std::size_t, const Piece& piece) { add(piece.corners, piece.outside); });
  mesh.faces = std::move(faces);
  mesh.unseen = std::move(marks);
  mesh.vertices.insert(mesh.vertices.end(), cut.vertices.begin(), cut.vertices.end());
  mesh.colors.insert(mesh.colors.end(), cut.colors.begin(), cut.colors.end());
  return outside;
}

void require_inside(std::size_t outside, const Mesh& mesh, const Boundary& boundary) {
  if (outside < mesh.faces.size()) return;
  const Eigen::AlignedBox2d limits = boundary.extent(), surface = extent_of(mesh, boundary);
  fail_in(boundary.name(),
          "lies outside of the surface: x from {:.2f} to {:.2f} and y from {:.2f} to {:.2f}, but "
          "the surface has x from {:.2f} to {:.2f} and y from {:.2f} to {:.2f}: are the "
          "coordinates those of the map?",
          limits.min().x(), limits.max().x(), limits.min().y(), limits.max().y(), surface.min().x(),
          surface.max().x(), surface.min().y(), surface.max().y());
}

}  // namespace

std::size_t mark_outside(Mesh& mesh, const Boundary& boundary) {
  const std::size_t outside = apply(cut_faces(mesh, boundary), mesh);
  require_inside(outside, mesh, boundary);
  return outside;
}

std::size_t mark_outside(TexturedMesh& mesh, const Boundary& boundary) {
  const CutFaces cut = cut_faces(mesh.mesh, boundary);
  if (!mesh.textures.empty()) {
    mesh.uv = split_uv(cut, mesh.uv);
    mesh.texture_of = inherited(cut, mesh.texture_of);
  }
  const std::size_t outside = apply(cut, mesh.mesh);
  require_inside(outside, mesh.mesh, boundary);
  return outside;
}

std::uint64_t bytes_to_mark(const Mesh& mesh) {
  const std::uint64_t copies = sizeof(mesh.faces[0]) + 1 + sizeof(TexturedMesh::Corners) + 4;
  return bytes_to_cut(mesh) + mesh.faces.size() * copies;
}

std::vector<std::uint32_t> outside_faces(const Mesh& mesh) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t f = 0; f < mesh.unseen.size(); ++f)
    if (mesh.unseen[f] == kOutside) found.push_back(f);
  return found;
}

void remove_outside(Mesh& mesh) {
  TexturedMesh textured;
  textured.mesh = std::move(mesh);
  remove_outside(textured);
  mesh = std::move(textured.mesh);
}

void remove_outside(TexturedMesh& mesh) {
  std::vector<std::uint8_t> inside_marks;
  for (std::uint8_t& mark : mesh.mesh.unseen) {
    if (mark != kOutside) inside_marks.push_back(mark);
    mark = mark == kOutside;
  }
  remove_marked_faces(mesh);
  if (std::ranges::count(inside_marks, 0) != std::ssize(inside_marks))
    mesh.mesh.unseen = std::move(inside_marks);
}

}  // namespace axial::boundary
