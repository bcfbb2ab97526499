// SPDX-License-Identifier: GPL-3.0-or-later
// A camera or a projector as plain numbers, to be dealt to lanes.
#pragma once

#include <type_traits>

#include "depth/lanes/scorer.h"
#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"
#include "refractive/pinhole_camera.h"

namespace axial::depth {

// A camera that can be dealt to lanes, number by number.
template <class Camera>
concept InLanes = requires(Camera camera) {
  camera.each_field([](auto&) {});
};

template <InLanes Camera>
inline constexpr lanes::CameraKind kLaneKind{};
template <>
inline constexpr lanes::CameraKind kLaneKind<refractive::PinholeCamera<float>> =
    lanes::CameraKind::pinhole;
template <>
inline constexpr lanes::CameraKind kLaneKind<refractive::FlatPortCamera<float>> =
    lanes::CameraKind::flat_port;
template <>
inline constexpr lanes::CameraKind kLaneKind<refractive::DomePortCamera<float>> =
    lanes::CameraKind::dome_port;

template <InLanes Fielded>
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

}  // namespace axial::depth
