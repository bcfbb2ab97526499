// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/self_intersections.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>

#include "base/parallel.h"

namespace axial::evaluate {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
using Face = std::array<std::uint32_t, 3>;

Point point_at(const Mesh& mesh, std::uint32_t vertex) {
  const Eigen::Vector3d x = mesh.vertices[vertex].cast<double>();
  return {x.x(), x.y(), x.z()};
}

std::array<Point, 3> corners_of(const Mesh& mesh, const Face& face) {
  return {point_at(mesh, face[0]), point_at(mesh, face[1]), point_at(mesh, face[2])};
}

// Two faces, each turned so that the common vertices are the first of both, in the same order.
struct Pair {
  Face a, b;
  int common = 0;
};

Pair turned(Face a, Face b) {
  int common = 0;
  for (int i = 0; i < 3; ++i) {
    const auto found = std::find(b.begin() + common, b.end(), a[static_cast<std::size_t>(i)]);
    if (found == b.end()) continue;
    std::iter_swap(found, b.begin() + common);
    std::swap(a[static_cast<std::size_t>(i)], a[static_cast<std::size_t>(common)]);
    ++common;
  }
  return {a, b, common};
}

bool intersect(const Mesh& mesh, const Face& first, const Face& second) {
  const auto [a, b, common] = turned(first, second);
  if (common == 3) return true;
  const auto [a0, a1, a2] = corners_of(mesh, a);
  const auto [b0, b1, b2] = corners_of(mesh, b);
  if (common == 2)
    return CGAL::coplanar(a0, a1, a2, b2) &&
           CGAL::coplanar_orientation(a0, a1, a2, b2) == CGAL::POSITIVE;
  const Kernel::Triangle_3 ta(a0, a1, a2), tb(b0, b1, b2);
  if (common == 0) return CGAL::do_intersect(ta, tb);
  return CGAL::do_intersect(ta, Kernel::Segment_3(b1, b2)) ||
         CGAL::do_intersect(tb, Kernel::Segment_3(a1, a2));
}

std::vector<Box> boxes_of(const Mesh& mesh) {
  std::vector<Box> boxes;
  boxes.reserve(mesh.faces.size());
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
    const auto [p, q, r] = corners_of(mesh, mesh.faces[i]);
    boxes.emplace_back(p.bbox() + q.bbox() + r.bbox(), i);
  }
  return boxes;
}

// Tests pairs of faces in portions, because a bad mesh may have very many whose boxes meet.
class Pairs {
 public:
  explicit Pairs(const Mesh& mesh) : mesh_(mesh), found_(mesh.faces.size(), false) {}

  void add(std::uint32_t a, std::uint32_t b) {
    constexpr std::size_t kPortion = 1 << 20;
    pairs_.push_back({a, b});
    if (pairs_.size() == kPortion) test();
  }

  void test() {
    std::vector<std::uint8_t> meet(pairs_.size(), 0);
    parallel_for(
        pairs_.size(),
        [&](std::size_t i) {
          const auto [a, b] = pairs_[i];
          meet[i] = intersect(mesh_, mesh_.faces[a], mesh_.faces[b]) ? 1 : 0;
        },
        kPointGrain);
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      if (meet[i]) found_[pairs_[i][0]] = found_[pairs_[i][1]] = true;
    pairs_.clear();
  }

  std::vector<std::uint32_t> faces() const {
    std::vector<std::uint32_t> faces;
    for (std::uint32_t i = 0; i < found_.size(); ++i)
      if (found_[i]) faces.push_back(i);
    return faces;
  }

 private:
  const Mesh& mesh_;
  std::vector<bool> found_;
  std::vector<std::array<std::uint32_t, 2>> pairs_;
};

}  // namespace

bool is_degenerate(const Mesh& mesh, const Face& face) {
  const auto [p, q, r] = corners_of(mesh, face);
  return CGAL::collinear(p, q, r);
}

std::vector<std::uint32_t> self_intersecting_faces(const Mesh& mesh) {
  std::vector<Box> boxes = boxes_of(mesh);
  Pairs pairs(mesh);
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(),
                                [&](const Box& a, const Box& b) { pairs.add(a.info(), b.info()); });
  pairs.test();
  return pairs.faces();
}

}  // namespace axial::evaluate
