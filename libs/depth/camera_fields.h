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

template <class Fielded>
concept HasFields = requires(Fielded fielded) {
  fielded.each_field([](auto&) {});
};

// A camera type that the SIMD code supports.
template <class Camera>
concept InLanes = HasFields<Camera> || std::is_same_v<Camera, AnyCamera<float>>;

// The CameraKind of each camera type that the SIMD code supports.
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
template <HasFields Camera>
inline constexpr lanes::CameraKind kLaneKind = lane_kind(static_cast<const Camera*>(nullptr));

// Returns the float fields of a camera or projector, in the order of each_field(). An integer
// field becomes CameraFields::steps. Precondition: at most lanes::kMaxCameraFields float fields.
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

// Calls visit(camera) with the concrete camera type, also if `camera` is an AnyCamera.
template <InLanes Camera, class Visit>
auto visit_kind(const Camera& camera, Visit&& visit) {
  if constexpr (HasFields<Camera>)
    return visit(camera);
  else
    return std::visit(visit, camera.kind());
}

template <InLanes Camera>
lanes::CameraKind kind_of(const Camera& camera) {
  return visit_kind(camera, []<class Kind>(const Kind&) { return kLaneKind<Kind>; });
}

}  // namespace axial::depth
