// SPDX-License-Identifier: GPL-3.0-or-later
// The light under water: the sun's, or lamps' that are fixed to the camera. Irradiances are in
// units in which a horizontal white surface just below the water's surface has 1, and a white
// surface that faces a lamp of power 1 at 1 m without water, too.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "simulate/optics.h"
#include "simulate/ray_scene.h"
#include "simulate/water.h"

namespace axial::simulate {

// Daylight in the world frame (z up).
struct Sun {
  double depth = 6;  // of the world's z = 0 below the water's surface [m]
  // To the sun, under water, unit; the share of the light from there. The rest comes evenly from
  // above.
  Eigen::Vector3d direction = Eigen::Vector3d(0.36, 0.25, 0.90).normalized();
  double direct = 0.5;
};

// A lamp in the camera frame [m]. Its intensity falls with the angle from its axis, to a half at
// `half_angle` [rad].
struct Lamp {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction{0, 0, 1};  // unit
  double half_angle = 0.7;
  double power = 1;
};

// Lamps if there are any, else the sun. Both together are not simulated.
struct Light {
  Sun sun;
  std::vector<Lamp> lamps;
};

// Two lamps of divers: left and right of the camera, turned inwards by 10 degrees.
std::vector<Lamp> usual_lamps();

// The light of a surface.
struct Irradiance {
  Spectrum light;
  float lit = 1;  // `light` as a share of the light that it would have without shadows
};

// Light for the photographs of one view. `scene` casts shadows. `water` and `scene` must outlive
// the object.
class LightOfView {
 public:
  LightOfView(const Light& light, const Water& water, const RayScene& scene, const View& view);

  // The light of a surface with the unit normal `normal` at `point` [world, m]. `face_normal`:
  // unit, of the face on which the point is; shadows of the face itself are avoided with it.
  Irradiance irradiance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                        const Eigen::Vector3d& face_normal) const;

  // Light that is scattered once into a ray [world], from its start on over `length` [m]. In units
  // of the light from a white surface whose irradiance is 1. The way is sampled 24 times. Shadows
  // in the water are left out.
  Spectrum veil(const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                double length) const;

 private:
  struct LampInWorld {
    Eigen::Vector3d place, direction;
    double half_angle, power;
  };

  Irradiance of_sun(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, bool lit) const;
  Irradiance of_lamps(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                      const Eigen::Vector3d& lifted) const;
  // The share of daylight that is scattered towards -direction.
  double scattered_daylight(const Eigen::Vector3d& direction) const;
  // The light of the lamps that is scattered at `point` towards -direction.
  Spectrum scattered_lamps(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;

  const Sun sun_;
  const Water& water_;
  const RayScene& scene_;
  std::vector<LampInWorld> lamps_;
  Spectrum source_;  // of the light, without water
};

}  // namespace axial::simulate
