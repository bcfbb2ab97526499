// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <limits>
#include <type_traits>

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/faces.h"
#include "geometry/triangle_distance.h"
#include "scene/check_mesh.h"

namespace axial::geometry {
namespace {

struct Search {
  const Mesh& mesh;
  Eigen::Vector3d point;
  double rounding;  // rounding error of `point` in the hierarchy, in float
  double best2 = std::numeric_limits<double>::infinity();
  Eigen::Vector3d closest = Eigen::Vector3d::Zero();
  std::uint32_t face = 0;
};

bool visit(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  const Eigen::Vector3d candidate =
      closest_on_triangle(search.point, corners_of(search.mesh, arguments->primID));
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

struct Surface::State {
  struct Release {
    void operator()(RTCDevice held) const { rtcReleaseDevice(held); }
    void operator()(RTCScene held) const { rtcReleaseScene(held); }
  };

  explicit State(const Mesh& given) : mesh(given) { divide(); }
  explicit State(Mesh&& given) : own(std::move(given)), mesh(own) { divide(); }

  void divide();
  // Throws an Error if Embree has reported one since the last call.
  void require_no_error() const {
    const RTCError error = rtcGetDeviceError(device.get());
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY)
      fail("there is not enough memory to search the mesh, which has {} faces", mesh.faces.size());
    fail("the mesh cannot be searched (error {} of the ray tracer)", static_cast<int>(error));
  }

  Mesh own;  // or empty
  const Mesh& mesh;
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene;
  std::vector<Eigen::Vector3f> vertices;  // and a spare one: Embree reads 16 bytes at a time
};

void Surface::State::divide() {
  check_mesh(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!is_small(mesh.vertices[i]))
      fail("vertex {} has a coordinate larger than {:g}", i, kLargest);
  vertices.reserve(mesh.vertices.size() + 1);
  vertices = mesh.vertices;
  vertices.emplace_back(Eigen::Vector3f::Zero());
  device.reset(rtcNewDevice(nullptr));
  if (!device) require_no_error();
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(),
                   static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT));
  RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             vertices.data(), 0, sizeof(Eigen::Vector3f), mesh.vertices.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.faces.data(), 0, sizeof(mesh.faces[0]), mesh.faces.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  const ThreadLimit one_builder(1);  // the same tree for any number of threads
  rtcCommitScene(scene.get());
  require_no_error();
}

Surface::Surface(const Mesh& mesh) : state_(std::make_unique<State>(mesh)) {}
Surface::Surface(Mesh&& mesh) : state_(std::make_unique<State>(std::move(mesh))) {}
Surface::~Surface() = default;
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;

ClosestPoint Surface::closest(const Eigen::Vector3d& point) const {
  Search search{state_->mesh, point,
                4 * std::numeric_limits<float>::epsilon() * point.cwiseAbs().maxCoeff()};
  RTCPointQuery query{};
  query.x = static_cast<float>(point.x());
  query.y = static_cast<float>(point.y());
  query.z = static_cast<float>(point.z());
  query.radius = std::numeric_limits<float>::infinity();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(state_->scene.get(), &query, &context, visit, &search);
  return {search.closest, std::sqrt(search.best2), search.face};
}

Eigen::Vector3d Surface::face_normal(std::uint32_t face) const {
  const Eigen::Vector3d normal = area_vector(state_->mesh, face);
  const double length = normal.norm();
  return length > 0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
}

bool Surface::between(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double at_from,
                      double at_to) const {
  RTCRay ray = ray_from(from, to - from);
  ray.tnear = static_cast<float>(at_from);
  ray.tfar = static_cast<float>(1 - at_to);
  if (!can_be_traced(ray)) return true;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(state_->scene.get(), &context, &ray);
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
  rtcIntersect1(state_->scene.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return SurfaceHit{query.hit.primID, query.hit.u, query.hit.v};
}

std::uint64_t bytes_of_surface(const Mesh& mesh) {
  constexpr std::uint64_t kTreePerFace = 160;  // Embree's tree while it is built
  return mesh.vertices.size() * sizeof(Eigen::Vector3f) + mesh.faces.size() * kTreePerFace;
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
