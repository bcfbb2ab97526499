// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/views/ray_caster.h"

#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"
#include "refractive/lens_camera.h"

namespace axial::depth {

using refractive::DomePortCamera;
using refractive::FlatPortCamera;
using refractive::LensDomePortCamera;
using refractive::LensFlatPortCamera;
using refractive::LensPinholeCamera;
using refractive::PinholeCamera;

template <InLanes Camera>
std::unique_ptr<const lanes::SceneTables> ray_tables(const Camera& camera) {
  auto tables = std::make_unique<lanes::SceneTables>();
  tables->kind = kind_of(camera);
  tables->reference = visit_kind(camera, [](const auto& kind) { return fields_of(kind); });
  return tables;
}

void LaneRayCaster::rays(int x, int y, RayTile& tile) const {
  static_assert(kRayTile == lanes::kLanes);
  lanes::LaneRays rays;
  scorer_->rays(static_cast<float>(x), static_cast<float>(y), rays);
  for (std::size_t k = 0; k < tile.size(); ++k) {
    const auto vector = [&](std::size_t from) {
      return Eigen::Vector3f(rays[from][k], rays[from + 1][k], rays[from + 2][k]);
    };
    tile[k].ray = {vector(0), vector(3)};
    tile[k].jacobian.origin << vector(6), vector(9);
    tile[k].jacobian.direction << vector(12), vector(15);
  }
}

template std::unique_ptr<const lanes::SceneTables> ray_tables(const PinholeCamera<float>&);
template std::unique_ptr<const lanes::SceneTables> ray_tables(const FlatPortCamera<float>&);
template std::unique_ptr<const lanes::SceneTables> ray_tables(const DomePortCamera<float>&);
template std::unique_ptr<const lanes::SceneTables> ray_tables(const LensPinholeCamera<float>&);
template std::unique_ptr<const lanes::SceneTables> ray_tables(const LensFlatPortCamera<float>&);
template std::unique_ptr<const lanes::SceneTables> ray_tables(const LensDomePortCamera<float>&);
template std::unique_ptr<const lanes::SceneTables> ray_tables(const AnyCamera<float>&);

}  // namespace axial::depth
