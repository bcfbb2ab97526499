// SPDX-License-Identifier: GPL-3.0-or-later
// Represents a camera or a projector as an array of numbers. The SIMD code takes cameras in this
// form.
#pragma once

#include <type_traits>

#include "depth/lanes/scorer.h"
#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"
#include "refractive/lens_camera.h"
#include "refractive/pinhole_camera.h"
#include "scene/any_camera.h"

namespace axial::depth {

// A camera or a projector that calls a function for each of its numbers (each_field() in
// refractive/axial_ray.h).
template <class Fielded>
concept HasFields = requires(Fielded fielded) {
  fielded.each_field([](auto&) {});
};

// A camera type that the SIMD code supports: one kind of camera, or AnyCamera, which contains a
// camera of any kind.
template <class Camera>
concept InLanes = HasFields<Camera> || std::is_same_v<Camera, AnyCamera<float>>;

// The CameraKind of each camera type that the SIMD code supports, except AnyCamera. The pointer
// selects the overload and is not read.
consteval lanes::CameraKind lane_kind(const refractive::PinholeCamera<float>*) {
  return lanes::CameraKind::pinhole;
}
consteval lanes::CameraKind lane_kind(const refractive::FlatPortCamera<float>*) {
  return lanes::CameraKind::flat_port;
}
consteval lanes::CameraKind lane_kind(const refractive::DomePortCamera<float>*) {
  return lanes::CameraKind::dome_port;
}
consteval lanes::CameraKind lane_kind(const refractive::LensPinholeCamera<float>*) {
  return lanes::CameraKind::lens_pinhole;
}
consteval lanes::CameraKind lane_kind(const refractive::LensFlatPortCamera<float>*) {
  return lanes::CameraKind::lens_flat_port;
}
consteval lanes::CameraKind lane_kind(const refractive::LensDomePortCamera<float>*) {
  return lanes::CameraKind::lens_dome_port;
}
// The CameraKind of the type Camera.
template <HasFields Camera>
inline constexpr lanes::CameraKind kLaneKind = lane_kind(static_cast<const Camera*>(nullptr));

// Returns the numbers of a camera or projector. The float numbers become CameraFields::value, in
// the order of each_field(). The integer, if there is one, becomes CameraFields::steps.
// Preconditions: at most lanes::kMaxCameraFields floats and at most one integer.
template <HasFields Fielded>
lanes::CameraFields fields_of(Fielded from) {
  lanes::CameraFields fields;
  std::size_t k = 0;
  from.each_field([&](auto field) {
    if constexpr (std::is_same_v<decltype(field), int>)
      fields.steps = field;
    else
      fields.value.at(k++) = field;
  });
  return fields;
}

// Calls `visit` with `camera`, or, if `camera` is an AnyCamera, with the camera that it contains.
// Returns the result of the call.
template <InLanes Camera, class Visit>
auto visit_kind(const Camera& camera, Visit&& visit) {
  if constexpr (HasFields<Camera>)
    return visit(camera);
  else
    return std::visit(visit, camera.kind());
}

// The kind of `camera`, or, if `camera` is an AnyCamera, of the camera that it contains.
template <InLanes Camera>
lanes::CameraKind kind_of(const Camera& camera) {
  return visit_kind(camera, []<class Kind>(const Kind&) { return kLaneKind<Kind>; });
}

}  // namespace axial::depth
