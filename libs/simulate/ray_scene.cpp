// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/ray_scene.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <limits>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace axial::simulate {
namespace {

RTCRay make_ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double near,
                double far) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x());
  ray.org_y = static_cast<float>(origin.y());
  ray.org_z = static_cast<float>(origin.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = static_cast<float>(near);
  ray.tfar = static_cast<float>(far);
  ray.mask = 0xFFFFFFFFu;
  return ray;
}

}  // namespace

struct RayScene::State {
  struct Release {
    void operator()(RTCDevice embree_device) const { rtcReleaseDevice(embree_device); }
    void operator()(RTCScene embree_scene) const { rtcReleaseScene(embree_scene); }
  };
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene;
  std::vector<Eigen::Vector3f> vertices;  // and a spare one: Embree reads 16 bytes at a time
  std::vector<Face> faces;
};

RayScene::RayScene(const TriangleMesh& mesh) : state_(std::make_unique<State>()) {
  if (mesh.faces.empty()) fail("mesh has no faces");
  for (const Face& face : mesh.faces)
    for (const std::uint32_t corner : face)
      if (corner >= mesh.vertices.size())
        fail("a mesh face refers to vertex {}, but there are {}", corner, mesh.vertices.size());
  State& s = *state_;
  s.vertices = mesh.vertices;
  s.vertices.emplace_back(Eigen::Vector3f::Zero());
  s.faces = mesh.faces;

  s.device.reset(rtcNewDevice(nullptr));
  if (!s.device)
    fail("the ray tracer cannot be started: is there enough memory? (error {})",
         static_cast<int>(rtcGetDeviceError(nullptr)));
  s.scene.reset(rtcNewScene(s.device.get()));
  rtcSetSceneFlags(s.scene.get(), RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(s.device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             s.vertices.data(), 0, sizeof(Eigen::Vector3f), mesh.vertices.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, s.faces.data(),
                             0, sizeof(Face), s.faces.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(s.scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  const ThreadLimit one_builder(1);
  rtcCommitScene(s.scene.get());
  if (const RTCError error = rtcGetDeviceError(s.device.get()); error != RTC_ERROR_NONE)
    fail("the ray tracer cannot hold the mesh: is there enough memory? (error {})",
         static_cast<int>(error));
}

RayScene::~RayScene() = default;

std::optional<Hit> RayScene::first_hit(const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = make_ray(origin, direction, 0, std::numeric_limits<double>::infinity());
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->scene.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  const auto& [i, j, k] = state_->faces[query.hit.primID];
  const Eigen::Vector3d a = state_->vertices[i].cast<double>();
  const Eigen::Vector3d b = state_->vertices[j].cast<double>();
  const Eigen::Vector3d c = state_->vertices[k].cast<double>();
  const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
  const double slope = normal.dot(direction);
  Hit hit{query.ray.tfar, query.hit.primID, query.hit.u, query.hit.v, normal};
  // For a face seen nearly edge-on, the plane is less accurate than Embree's float distance.
  if (std::abs(slope) > 1e-3) hit.distance = normal.dot(a - origin) / slope;
  return hit;
}

bool RayScene::blocked(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double near,
                       double far) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = make_ray(origin, direction, near, far);
  rtcOccluded1(state_->scene.get(), &context, &ray);
  return ray.tfar < 0;
}

Eigen::Vector3d smooth_normal(const TriangleMesh& mesh, std::span<const Eigen::Vector3f> normals,
                              const Hit& hit) {
  const auto& [a, b, c] = mesh.faces[hit.face];
  const Eigen::Vector3f blend =
      (1 - hit.u - hit.v) * normals[a] + hit.u * normals[b] + hit.v * normals[c];
  return blend.cast<double>().normalized();
}

}  // namespace axial::simulate
