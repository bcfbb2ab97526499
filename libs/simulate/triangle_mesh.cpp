// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/parallel.h"

namespace axial::simulate {
namespace {

constexpr std::uint32_t kUnused = 0xFFFFFFFFu;

void remove_unused_vertices(TriangleMesh& mesh) {
  std::vector<std::uint32_t> new_index(mesh.vertices.size(), kUnused);
  std::vector<Eigen::Vector3f> kept;
  std::vector<float> thickness;
  for (Face& face : mesh.faces) {
    for (std::uint32_t& corner : face) {
      if (new_index[corner] == kUnused) {
        new_index[corner] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(mesh.vertices[corner]);
        if (!mesh.thickness.empty()) thickness.push_back(mesh.thickness[corner]);
      }
      corner = new_index[corner];
    }
  }
  mesh.vertices = std::move(kept);
  mesh.thickness = std::move(thickness);
}

TriangleMesh icosahedron() {
  const float g = 0.5f * (1.0f + std::sqrt(5.0f));
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Eigen::Vector3f& v : mesh.vertices) v.normalize();
  return mesh;
}

TriangleMesh split_in_four(TriangleMesh mesh) {
  std::unordered_map<std::uint64_t, std::uint32_t> middle_of;
  middle_of.reserve(mesh.faces.size() * 3 / 2);
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
    const auto [entry, fresh] =
        middle_of.try_emplace(key, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
    return entry->second;
  };
  std::vector<Face> faces;
  faces.reserve(mesh.faces.size() * 4);
  for (const auto& [a, b, c] : mesh.faces) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    faces.insert(faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  mesh.faces = std::move(faces);
  return mesh;
}

}  // namespace

void append(TriangleMesh& mesh, const TriangleMesh& part) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  if (!mesh.thickness.empty() || !part.thickness.empty()) {
    mesh.thickness.resize(mesh.vertices.size(), 0.0f);
    mesh.thickness.insert(mesh.thickness.end(), part.thickness.begin(), part.thickness.end());
    mesh.thickness.resize(mesh.vertices.size() + part.vertices.size(), 0.0f);
  }
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [a, b, c] : part.faces) mesh.faces.push_back({a + base, b + base, c + base});
}

void remove_hidden(TriangleMesh& mesh, const std::function<bool(const Eigen::Vector3d&)>& hidden) {
  std::vector<char> is_hidden(mesh.vertices.size());
  parallel_for(
      mesh.vertices.size(),
      [&](std::size_t i) { is_hidden[i] = hidden(mesh.vertices[i].cast<double>()); }, 4096);
  std::erase_if(mesh.faces, [&](const Face& face) {
    return is_hidden[face[0]] && is_hidden[face[1]] && is_hidden[face[2]];
  });
  remove_unused_vertices(mesh);
}

std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const auto& [a, b, c] : mesh.faces) {
    const Eigen::Vector3f& p = mesh.vertices[a];
    const Eigen::Vector3f area = (mesh.vertices[b] - p).cross(mesh.vertices[c] - p);
    for (const std::uint32_t corner : {a, b, c}) normals[corner] += area;
  }
  for (Eigen::Vector3f& n : normals) n.normalize();
  return normals;
}

TriangleMesh grid_mesh(std::size_t rows, std::size_t columns, bool wrap_columns,
                       const std::function<Eigen::Vector3d(std::size_t, std::size_t)>& at) {
  TriangleMesh mesh;
  mesh.vertices.resize(rows * columns);
  parallel_for(
      rows,
      [&](std::size_t r) {
        for (std::size_t c = 0; c < columns; ++c)
          mesh.vertices[r * columns + c] = at(r, c).cast<float>();
      },
      8);
  const std::size_t cells = wrap_columns ? columns : columns - 1;
  mesh.faces.reserve(2 * (rows - 1) * cells);
  for (std::size_t r = 0; r + 1 < rows; ++r) {
    for (std::size_t c = 0; c < cells; ++c) {
      const auto index = [&](std::size_t row, std::size_t column) {
        return static_cast<std::uint32_t>(row * columns + column % columns);
      };
      const std::uint32_t i = index(r, c), j = index(r + 1, c);
      const std::uint32_t k = index(r + 1, c + 1), l = index(r, c + 1);
      mesh.faces.push_back({i, j, k});
      mesh.faces.push_back({i, k, l});
    }
  }
  return mesh;
}

TriangleMesh unit_sphere(int levels) {
  TriangleMesh mesh = icosahedron();
  for (int level = 0; level < levels; ++level) mesh = split_in_four(std::move(mesh));
  return mesh;
}

}  // namespace axial::simulate
