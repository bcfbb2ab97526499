// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/frame.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "scene/decompositions.h"

namespace axial::map {
namespace {

// A sphere around the place where most of the surface is. Without a radius it is everything.
struct Neighbourhood {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // from the first vertex
  double radius = std::numeric_limits<double>::infinity();
};

// A face, in coordinates from the first vertex of the mesh, against cancellation.
struct FaceOfFit {
  Eigen::Matrix3d corners;
  Eigen::Vector3d mean;
  double area;

  FaceOfFit(const Mesh& mesh, std::size_t face) {
    const Eigen::Vector3d near = mesh.vertices.front().cast<double>();
    const auto& [a, b, c] = mesh.faces[face];
    corners << mesh.vertices[a].cast<double>() - near, mesh.vertices[b].cast<double>() - near,
        mesh.vertices[c].cast<double>() - near;
    mean = corners.rowwise().mean();
    area = 0.5 * (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)).norm();
  }
};

struct WeightedValue {
  double value, weight;
};

// The lowest value up to which the values have half of the weight.
double weighted_median(std::vector<WeightedValue> values) {
  std::ranges::sort(values, {}, &WeightedValue::value);
  double all = 0, below = 0;
  for (const WeightedValue& value : values) all += value.weight;
  for (const WeightedValue& value : values)
    if ((below += value.weight) >= 0.5 * all) return value.value;
  return 0;
}

// Five times the median distance of the surface from its median, by area. Up to 100,000 faces at
// equal distances in the list of faces stand for all.
Neighbourhood neighbourhood_of(const Mesh& mesh) {
  constexpr std::size_t kSample = 100'000;
  constexpr double kFar = 5;
  const std::size_t step = std::max<std::size_t>(1, mesh.faces.size() / kSample);
  std::array<std::vector<WeightedValue>, 3> places;
  for (std::size_t f = 0; f < mesh.faces.size(); f += step) {
    const FaceOfFit face(mesh, f);
    for (std::size_t k = 0; k < 3; ++k)
      places[k].push_back({face.mean[static_cast<Eigen::Index>(k)], face.area});
  }
  Neighbourhood near;
  for (std::size_t k = 0; k < 3; ++k)
    near.centre[static_cast<Eigen::Index>(k)] = weighted_median(places[k]);
  std::vector<WeightedValue> distances;
  for (std::size_t i = 0; i < places[0].size(); ++i) {
    const Eigen::Vector3d at(places[0][i].value, places[1][i].value, places[2][i].value);
    distances.push_back({(at - near.centre).norm(), places[0][i].weight});
  }
  near.radius = kFar * weighted_median(std::move(distances));
  return near;
}

struct Fit {
  double area = 0;
  FittedPlane plane = {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
};

// The plane of the faces in the neighbourhood. `area` is 0 if they have no area.
Fit fit_of(const Mesh& mesh, const Neighbourhood& near) {
  // Moments of the surface. The second moment of a triangle of area A with the corners v_k and
  // their mean g is A / 12 (9 g g' + sum of v_k v_k').
  double area = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const FaceOfFit face(mesh, f);
    if ((face.mean - near.centre).norm() > near.radius) continue;
    area += face.area;
    first += face.area * face.mean;
    second += face.area / 12 *
              (9 * face.mean * face.mean.transpose() + face.corners * face.corners.transpose());
  }
  if (!(area > 0)) return {};
  const Eigen::Vector3d centroid = first / area;
  const SymmetricEigen3 eigen(second / area - centroid * centroid.transpose());
  return {area, {mesh.vertices.front().cast<double>() + centroid, eigen.eigenvectors().col(0)}};
}

}  // namespace

MapFrame frame_with_up(const Eigen::Vector3d& up, const LocalFrame& mesh_frame) {
  const Eigen::Vector3d u = up.normalized();
  const Eigen::Vector3d right =
      std::abs(u.x()) < std::sqrt(0.5) ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d x = (right - right.dot(u) * u).normalized();
  MapFrame frame;
  frame.axes << x.transpose(), u.cross(x).transpose(), u.transpose();
  frame.origin = frame.axes * mesh_frame.origin;
  if (!frame.axes.isIdentity(0)) frame.origin.z() = 0;
  return frame;
}

FittedPlane fitted_plane(const Mesh& mesh) {
  constexpr double kMostFar = 0.02;     // share of the area
  constexpr double kOtherPlane = 1e-3;  // sine of the angle
  const Fit all = fit_of(mesh, {});
  if (!(all.area > 0)) fail("the mesh has no area");
  const Fit close = fit_of(mesh, neighbourhood_of(mesh));
  const bool has_far = close.area > 0 && close.area < all.area;
  if (!has_far || close.area < (1 - kMostFar) * all.area) return all.plane;
  const bool is_other = close.plane.normal.cross(all.plane.normal).norm() > kOtherPlane;
  return is_other ? close.plane : all.plane;
}

Eigen::Vector3d fitted_up(const Mesh& mesh, std::span<const Eigen::Vector3d> centres) {
  const FittedPlane plane = fitted_plane(mesh);
  Eigen::Vector3d to_cameras = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& centre : centres) to_cameras += centre - plane.point;
  const double side = plane.normal.dot(to_cameras);
  if (side == 0) fail("the camera centres do not show which side of the mesh is up");
  return side > 0 ? plane.normal : Eigen::Vector3d(-plane.normal);
}

void require_possible(double columns, double rows, double pixel, double most) {
  if (!(std::max(columns, rows) <= most))
    fail("{} {:g}: the map would have {:.0f} x {:.0f} pixels, and {:.0f} per side is the most",
         setting("ground_sample_distance"), pixel, columns, rows, most);
}

MapGrid grid_around(const Mesh& mesh, const MapFrame& frame, double pixel, double most) {
  Eigen::AlignedBox2d box;
  for (const auto& face : mesh.faces)
    for (const std::uint32_t corner : face)
      box.extend(frame.to_map(mesh.vertices[corner].cast<double>()).head<2>());
  return grid_over(box, pixel, most);
}

MapGrid grid_over(const Eigen::AlignedBox2d& box, double pixel, double most) {
  // In pixels from the origin of the map.
  constexpr double kTolerance = 1e-3;
  const Eigen::Array2d low = (box.min().array() / pixel + kTolerance).floor();
  const Eigen::Array2d high = (box.max().array() / pixel - kTolerance).ceil().max(low + 1);
  const Eigen::Array2d size = high - low;
  require_possible(size.x(), size.y(), pixel, most);
  return {low.x() * pixel, high.y() * pixel, pixel, static_cast<int>(size.x()),
          static_cast<int>(size.y())};
}

}  // namespace axial::map
