// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/housing_change.h"

#include <ceres/jet.h>

namespace axial::pose {
namespace {

using Jet = ceres::Jet<double, kHousingNumbers>;

refractive::FlatPortCamera<Jet> camera_behind(const refractive::FlatPort<Jet>& port,
                                              const refractive::PinholeLens<Jet>& lens, int width,
                                              int height) {
  return {lens, port, width, height};
}

refractive::DomePortCamera<Jet> camera_behind(const refractive::DomePort<Jet>& port,
                                              const refractive::PinholeLens<Jet>& lens, int width,
                                              int height) {
  return {lens, port, width, height};
}

refractive::AxialRay<Jet> ray(const CameraModel& measured, const HousingChange<Jet>& change,
                              const Eigen::Vector2d& pixel) {
  const refractive::PinholeLens<Jet> lens = with_change(measured.lens, change);
  const refractive::Vector2<Jet> at = pixel.cast<Jet>();
  if (!measured.port) return refractive::PinholeCamera<Jet>(lens).ray(at);
  return std::visit(
      [&](const auto& port) {
        return camera_behind(with_change(port, change), lens, measured.width, measured.height)
            .ray(at);
      },
      *measured.port);
}

}  // namespace

CameraModel with_change(const CameraModel& measured, const HousingChange<double>& change) {
  CameraModel camera = measured;
  camera.lens = with_change(measured.lens, change);
  if (measured.port)
    camera.port = std::visit(
        [&](const auto& port) { return refractive::Port<double>(with_change(port, change)); },
        *measured.port);
  return camera;
}

Eigen::Matrix<double, 3, kHousingNumbers> ray_by_change(const CameraModel& measured,
                                                        const HousingChange<double>& change,
                                                        const Eigen::Vector2d& pixel,
                                                        double lambda) {
  HousingChange<Jet> jets;
  for (int k = 0; k < kHousingNumbers; ++k) jets(k) = Jet(change(k), k);
  const refractive::Vector3<Jet> point = ray(measured, jets, pixel).at(Jet(lambda));
  Eigen::Matrix<double, 3, kHousingNumbers> derivative;
  for (int k = 0; k < 3; ++k) derivative.row(k) = point(k).v.transpose();
  return derivative;
}

}  // namespace axial::pose
