// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace axial::simulate {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLift = 0.002;  // keeps a face from shading itself [m]

// The intensity of a lamp in the direction of `cosine` from its axis, as a share of its largest.
double cone(double cosine, double half_angle) {
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) / half_angle;
  return std::exp2(-angle * angle);
}

// Directions from which light comes evenly from above, each for the same solid angle: rings at
// heights that cut the half sphere into equal parts.
const std::vector<Eigen::Vector3d>& from_above() {
  static const std::vector<Eigen::Vector3d> directions = [] {
    constexpr int kRings = 4, kEach = 8;
    std::vector<Eigen::Vector3d> all;
    for (int ring = 0; ring < kRings; ++ring)
      for (int i = 0; i < kEach; ++i) {
        const double z = (ring + 0.5) / kRings, turn = 2 * kPi * (i + 0.5 * (ring % 2)) / kEach;
        const double across = std::sqrt(1 - z * z);
        all.emplace_back(across * std::cos(turn), across * std::sin(turn), z);
      }
    return all;
  }();
  return directions;
}

}  // namespace

std::vector<Lamp> usual_lamps() {
  std::vector<Lamp> lamps;
  for (const double side : {-1.0, 1.0})
    lamps.push_back({{0.35 * side, -0.1, 0}, Eigen::Vector3d(-0.17 * side, 0.05, 1).normalized()});
  return lamps;
}

LightOfView::LightOfView(const Light& light, const Water& water, const RayScene& scene,
                         const View& view)
    : sun_(light.sun),
      water_(water),
      scene_(scene),
      source_(light.lamps.empty() ? daylight() : white_led()) {
  const Eigen::Matrix3d to_world = view.rotation.transpose();
  for (const Lamp& lamp : light.lamps)
    lamps_.push_back({view.centre + to_world * lamp.place, to_world * lamp.direction,
                      lamp.half_angle, lamp.power});
}

Irradiance LightOfView::irradiance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                   const Eigen::Vector3d& face_normal) const {
  const Eigen::Vector3d lifted = point + kLift * face_normal;
  if (!lamps_.empty()) return of_lamps(point, normal, lifted);
  const bool lit =
      face_normal.dot(sun_.direction) > 0 && !scene_.blocked(lifted, sun_.direction, 0, 1e3);
  return of_sun(point, normal, lit);
}

Irradiance LightOfView::of_sun(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                               bool lit) const {
  const double straight =
      sun_.direct * std::max(0.0, normal.dot(sun_.direction)) / sun_.direction.z();
  const double even = (1 - sun_.direct) * 0.5 * (1 + normal.z());
  const double share = even + (lit ? straight : 0.0);
  const auto depth = static_cast<float>(sun_.depth - point.z());
  return {static_cast<float>(share) * source_ * (-water_.daylight_loss * depth).exp(),
          lit ? 1.0f : static_cast<float>(even / std::max(even + straight, 1e-9))};
}

Irradiance LightOfView::of_lamps(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                 const Eigen::Vector3d& lifted) const {
  Spectrum sum = Spectrum::Zero(), shadowed = Spectrum::Zero();
  for (const LampInWorld& lamp : lamps_) {
    const Eigen::Vector3d way = lamp.place - point;
    const double distance = way.norm();
    const Eigen::Vector3d to_lamp = way / distance;
    const double facing = normal.dot(to_lamp);
    if (facing <= 0) continue;
    const double strength = lamp.power * cone(-to_lamp.dot(lamp.direction), lamp.half_angle);
    const bool blocked = scene_.blocked(lifted, to_lamp, 0, distance - kLift);
    (blocked ? shadowed : sum) += static_cast<float>(strength * facing / (distance * distance)) *
                                  (-water_.loss() * static_cast<float>(distance)).exp();
  }
  const float all = sum.sum() + shadowed.sum();
  return {source_ * sum, all > 0 ? sum.sum() / all : 0.0f};
}

double LightOfView::scattered_daylight(const Eigen::Vector3d& direction) const {
  // Light travels along -d from the direction d, and after it along -direction.
  double even = 0;
  for (const Eigen::Vector3d& d : from_above()) even += phase(d.dot(direction));
  even *= 2 * kPi / static_cast<double>(from_above().size());
  const double straight = kPi * phase(sun_.direction.dot(direction)) / sun_.direction.z();
  return sun_.direct * straight + (1 - sun_.direct) * even;
}

Spectrum LightOfView::scattered_lamps(const Eigen::Vector3d& point,
                                      const Eigen::Vector3d& direction) const {
  Spectrum sum = Spectrum::Zero();
  for (const LampInWorld& lamp : lamps_) {
    const Eigen::Vector3d way = point - lamp.place;
    const double distance = std::max(way.norm(), 0.01);
    const Eigen::Vector3d along = way / distance;
    const double strength = lamp.power * cone(along.dot(lamp.direction), lamp.half_angle) * kPi *
                            phase(-along.dot(direction)) / (distance * distance);
    sum += static_cast<float>(strength) * (-water_.loss() * static_cast<float>(distance)).exp();
  }
  return sum;
}

Spectrum LightOfView::veil(const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                           double length) const {
  constexpr int kSteps = 24;
  const Spectrum rate = (1 - water_.blurred) * water_.scattering;
  const double step = length / kSteps;
  const auto even = static_cast<float>(lamps_.empty() ? scattered_daylight(direction) : 0);
  Spectrum sum = Spectrum::Zero();
  for (int i = 0; i < kSteps; ++i) {
    const double way = (i + 0.5) * step;
    const Eigen::Vector3d point = start + way * direction;
    const auto depth = static_cast<float>(sun_.depth - point.z());
    const Spectrum here = lamps_.empty() ? Spectrum(even * (-water_.daylight_loss * depth).exp())
                                         : scattered_lamps(point, direction);
    sum += here * (-water_.loss() * static_cast<float>(way)).exp();
  }
  return source_ * rate * sum * static_cast<float>(step);
}

}  // namespace axial::simulate
