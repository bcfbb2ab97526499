// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/triangle_distance.h"
#include "private/embree_errors.h"

namespace axial::geometry {

struct Surface::Impl {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  std::array<Eigen::Vector3d, 3> corners(std::uint32_t face) const {
    const auto& f = faces[face];
    return {vertices[f[0]].cast<double>(), vertices[f[1]].cast<double>(),
            vertices[f[2]].cast<double>()};
  }
};

namespace {

struct Search {
  const std::vector<Eigen::Vector3f>* vertices;
  const std::vector<std::array<std::uint32_t, 3>>* faces;
  Eigen::Vector3d point;
  double rounding;  // rounding error of `point` in the hierarchy, in float
  double best2 = std::numeric_limits<double>::infinity();
  Eigen::Vector3d closest = Eigen::Vector3d::Zero();
  std::uint32_t face = 0;
};

bool visit(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  const auto& f = (*search.faces)[arguments->primID];
  const auto& v = *search.vertices;
  const Eigen::Vector3d candidate = closest_on_triangle(
      search.point, {v[f[0]].cast<double>(), v[f[1]].cast<double>(), v[f[2]].cast<double>()});
  const double distance2 = (candidate - search.point).squaredNorm();
  // Of faces at equal distance the lower index is taken, so that the result does not depend on the
  // hierarchy.
  const bool nearer =
      distance2 < search.best2 || (distance2 == search.best2 && arguments->primID < search.face);
  if (!nearer) return false;
  const bool shrinks = distance2 < search.best2;
  search.best2 = distance2;
  search.closest = candidate;
  search.face = arguments->primID;
  if (!shrinks) return false;
  // A little wider than the distance found, because boxes are compared in float.
  arguments->query->radius =
      static_cast<float>(std::sqrt(distance2) * (1 + 1e-6) + search.rounding);
  return true;
}

// Embree leaves out triangles with larger coordinates, and aborts at rays with larger numbers.
constexpr float kLargest = 1e18f;

bool is_small(const Eigen::Vector3f& x) {
  return (x.array().abs() <= kLargest).all();
}

bool can_be_traced(const RTCRay& ray) {
  return is_small({ray.org_x, ray.org_y, ray.org_z}) && is_small({ray.dir_x, ray.dir_y, ray.dir_z});
}

// A ray without end.
RTCRay ray_from(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3f from = origin.cast<float>(), along = direction.cast<float>();
  RTCRay ray{};
  ray.org_x = from.x();
  ray.org_y = from.y();
  ray.org_z = from.z();
  ray.dir_x = along.x();
  ray.dir_y = along.y();
  ray.dir_z = along.z();
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0u;
  return ray;
}

}  // namespace

void require_valid(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!mesh.vertices[i].allFinite()) fail("vertex {} of the mesh is not finite", i);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    for (const std::uint32_t corner : mesh.faces[i])
      if (corner >= mesh.vertices.size())
        fail("face {} of the mesh refers to vertex {}, but there are {}", i, corner,
             mesh.vertices.size());
}

Surface::Surface(const Mesh& mesh) : impl_(std::make_unique<Impl>()) {
  if (mesh.faces.empty()) fail("the mesh has no faces");
  require_valid(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!is_small(mesh.vertices[i]))
      fail("vertex {} of the mesh has a coordinate larger than {:g}", i, kLargest);
  impl_->vertices = mesh.vertices;
  impl_->faces = mesh.faces;
  impl_->device = rtcNewDevice(nullptr);
  if (!impl_->device) require_no_error(nullptr, mesh.faces.size());
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(Eigen::Vector3f), impl_->vertices.size());
  void* faces = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                        sizeof impl_->faces[0], impl_->faces.size());
  require_no_error(impl_->device, mesh.faces.size());
  // NOLINTNEXTLINE(bugprone-undefined-memory-manipulation): a Vector3f is three floats.
  std::memcpy(vertices, impl_->vertices.data(), impl_->vertices.size() * sizeof(Eigen::Vector3f));
  std::memcpy(faces, impl_->faces.data(), impl_->faces.size() * sizeof impl_->faces[0]);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene, geometry);
  rtcReleaseGeometry(geometry);
  const ThreadLimit one_builder(1);
  rtcCommitScene(impl_->scene);
  require_no_error(impl_->device, mesh.faces.size());
}

Surface::~Surface() = default;
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;

ClosestPoint Surface::closest(const Eigen::Vector3d& point) const {
  Search search{&impl_->vertices, &impl_->faces, point,
                4 * std::numeric_limits<float>::epsilon() * point.cwiseAbs().maxCoeff()};
  RTCPointQuery query{};
  query.x = static_cast<float>(point.x());
  query.y = static_cast<float>(point.y());
  query.z = static_cast<float>(point.z());
  query.radius = std::numeric_limits<float>::infinity();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene, &query, &context, visit, &search);
  return {search.closest, std::sqrt(search.best2), search.face};
}

Eigen::Vector3d Surface::face_normal(std::uint32_t face) const {
  const auto corners = impl_->corners(face);
  const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double length = normal.norm();
  return length > 0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
}

bool Surface::blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double skip) const {
  RTCRay ray = ray_from(from, to - from);
  ray.tnear = static_cast<float>(skip);
  ray.tfar = 1;
  if (!can_be_traced(ray)) return true;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(impl_->scene, &context, &ray);
  return ray.tfar < 0;
}

std::optional<SurfaceHit> Surface::first_hit(const Eigen::Vector3d& origin,
                                             const Eigen::Vector3d& direction) const {
  RTCRayHit query{};
  query.ray = ray_from(origin, direction);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  if (!can_be_traced(query.ray)) return {};
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return SurfaceHit{query.hit.primID, query.hit.u, query.hit.v};
}

std::vector<float> distances_to(const Surface& surface, std::span<const Eigen::Vector3f> points) {
  std::vector<float> distances(points.size());
  parallel_for(
      points.size(),
      [&](std::size_t i) {
        distances[i] = static_cast<float>(surface.closest(points[i].cast<double>()).distance);
      },
      4096);
  return distances;
}

}  // namespace axial::geometry
