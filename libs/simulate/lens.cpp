// SPDX-License-Identifier: GPL-3.0-or-later
// Distorted lenses. The code is independent of refractive/ and inverts the distortion in another
// way: each checks the other.
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "simulate/optics.h"

namespace axial::simulate {
namespace {

// Beyond this angle a lens is not used behind a port.
constexpr double kWidestAngle = 85 * std::numbers::pi / 180;

double radius_of_angle(const Bend& bend, double angle) {
  const double a2 = angle * angle;
  const auto& k = bend.k;
  return angle * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
}

double angle_of_radius(const Bend& bend, double radius) {
  double low = 0, high = kWidestAngle;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (radius_of_angle(bend, middle) < radius ? low : high) = middle;
  }
  return (low + high) / 2;
}

double stretch_at(const Bend& bend, const Eigen::Vector2d& p) {
  const double r2 = p.squaredNorm();
  return 1 + bend.k[0] * r2 + bend.k[1] * r2 * r2;
}

Eigen::Vector2d shift_at(const Bend& bend, const Eigen::Vector2d& p) {
  const double r2 = p.squaredNorm(), p1 = bend.k[2], p2 = bend.k[3];
  return {2 * p1 * p.x() * p.y() + p2 * (r2 + 2 * p.x() * p.x()),
          p1 * (r2 + 2 * p.y() * p.y()) + 2 * p2 * p.x() * p.y()};
}

// Inverts the perspective distortion with a damped fixed-point iteration: subtracts the tangential
// shift at the last estimate from d, and divides by the radial factor there.
Eigen::Vector2d unbend(const Bend& bend, const Eigen::Vector2d& d) {
  Eigen::Vector2d p = d;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d next = (d - shift_at(bend, p)) / stretch_at(bend, p);
    if ((next - p).norm() < 1e-15) return next;
    p = (p + next) / 2;
  }
  return p;
}

}  // namespace

Eigen::Vector2d pixel_of(const Lens& lens, const Eigen::Vector3d& direction) {
  if (!lens.bend)
    return {lens.focal * direction.x() / direction.z() + lens.cx,
            lens.focal * direction.y() / direction.z() + lens.cy};
  Eigen::Vector2d p = direction.head<2>() / direction.z();
  if (lens.bend->fisheye) {
    const double r = p.norm();
    if (r > 0) p *= radius_of_angle(*lens.bend, std::atan(r)) / r;
  } else {
    p = (stretch_at(*lens.bend, p) * p + shift_at(*lens.bend, p)).eval();
  }
  return {lens.focal * p.x() + lens.cx, lens.focal * p.y() + lens.cy};
}

Eigen::Vector3d direction_of(const Lens& lens, double u, double v) {
  const Eigen::Vector2d d((u - lens.cx) / lens.focal, (v - lens.cy) / lens.focal);
  if (!lens.bend) return Eigen::Vector3d(d.x(), d.y(), 1.0).normalized();
  if (!lens.bend->fisheye) {
    const Eigen::Vector2d p = unbend(*lens.bend, d);
    return Eigen::Vector3d(p.x(), p.y(), 1.0).normalized();
  }
  const double r = d.norm(), angle = angle_of_radius(*lens.bend, r);
  if (!(r > 0)) return Eigen::Vector3d::UnitZ();
  const Eigen::Vector2d across = d * (std::sin(angle) / r);
  return {across.x(), across.y(), std::cos(angle)};
}

namespace {

// Beyond a fold of the lens, up to the next fold, the image is mirrored.
bool is_turned_over(const Lens& lens, const Eigen::Vector2d& p) {
  constexpr double kStep = 1e-6;
  const auto at = [&](double x, double y) {
    return pixel_of(lens, Eigen::Vector3d(p.x() + x, p.y() + y, 1.0));
  };
  Eigen::Matrix2d slope;
  slope << at(kStep, 0) - at(-kStep, 0), at(0, kStep) - at(0, -kStep);
  return !(slope.determinant() > 0);
}

// True if the pixel has a direction and there is no fold between it and the axis.
bool reaches(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d direction = direction_of(lens, pixel.x(), pixel.y());
  if (!((pixel_of(lens, direction) - pixel).norm() < 1e-6)) return false;
  constexpr int kSteps = 64;
  for (int i = 1; i <= kSteps; ++i)
    if (is_turned_over(lens, direction.head<2>() / direction.z() * i / kSteps)) return false;
  return true;
}

}  // namespace

void check_lens(const Lens& lens) {
  if (!lens.bend) return;
  // The border of the image, corners included.
  constexpr int kSamples = 32;
  for (int i = 0; i <= kSamples; ++i) {
    const double share = double(i) / kSamples;
    const double u = share * lens.width - 0.5, v = share * lens.height - 0.5;
    for (const Eigen::Vector2d& pixel :
         {Eigen::Vector2d(u, -0.5), Eigen::Vector2d(u, lens.height - 0.5), Eigen::Vector2d(-0.5, v),
          Eigen::Vector2d(lens.width - 0.5, v)})
      if (!reaches(lens, pixel))
        fail("a lens with the coefficients {} {} {} {} has no ray at pixel ({}, {})",
             lens.bend->k[0], lens.bend->k[1], lens.bend->k[2], lens.bend->k[3], pixel.x(),
             pixel.y());
  }
}

}  // namespace axial::simulate
