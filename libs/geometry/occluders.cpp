// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/occluders.h"

#include <embree3/rtcore.h>

#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "private/embree_errors.h"
#include "scene/check_mesh.h"

namespace axial::geometry {
namespace {

// Embree leaves out triangles with larger coordinates, and aborts at rays with larger numbers.
constexpr float kLargestCoordinate = 1e18f;

bool is_within_limit(const Eigen::Vector3f& x) {
  return (x.array().abs() <= kLargestCoordinate).all();
}

}  // namespace

struct Occluders::State {
  struct Release {
    void operator()(RTCDevice held) const { rtcReleaseDevice(held); }
    void operator()(RTCScene held) const { rtcReleaseScene(held); }
  };
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene;
  std::vector<Eigen::Vector3f> vertices;  // and a spare one: Embree reads 16 bytes at a time
};

Occluders::Occluders(const Mesh& mesh) : state_(std::make_unique<State>()) {
  check_mesh(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!is_within_limit(mesh.vertices[i]))
      fail("vertex {} has a coordinate larger than {:g}", i, kLargestCoordinate);
  State& s = *state_;
  s.vertices.reserve(mesh.vertices.size() + 1);
  s.vertices = mesh.vertices;
  s.vertices.emplace_back(Eigen::Vector3f::Zero());
  s.device.reset(rtcNewDevice(nullptr));
  if (!s.device) require_no_error(nullptr, mesh.faces.size());
  s.scene.reset(rtcNewScene(s.device.get()));
  rtcSetSceneFlags(s.scene.get(),
                   static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT));
  RTCGeometry geometry = rtcNewGeometry(s.device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             s.vertices.data(), 0, sizeof(Eigen::Vector3f), mesh.vertices.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.faces.data(), 0, sizeof(mesh.faces[0]), mesh.faces.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(s.scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  const ThreadLimit one_builder(1);  // the same tree for any number of threads
  rtcCommitScene(s.scene.get());
  require_no_error(s.device.get(), mesh.faces.size());
}

Occluders::~Occluders() = default;

bool Occluders::between(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        double tolerance) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  const Eigen::Vector3f start = from.cast<float>();
  const Eigen::Vector3f way = (to - from).cast<float>();
  if (!is_within_limit(start) || !is_within_limit(way)) return true;
  RTCRay ray{};
  ray.org_x = start.x(), ray.org_y = start.y(), ray.org_z = start.z();
  ray.dir_x = way.x(), ray.dir_y = way.y(), ray.dir_z = way.z();
  ray.tfar = static_cast<float>(1 - tolerance);
  ray.mask = 0xFFFFFFFFu;
  rtcOccluded1(state_->scene.get(), &context, &ray);
  return ray.tfar < 0;
}

}  // namespace axial::geometry
