// SPDX-License-Identifier: GPL-3.0-or-later
#include "lens/models.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace axial::lens {
namespace {

using Eigen::Vector2d;
using Bent = refractive::LensDistortion<double>;

// a[0] x + a[1] x^2 + ...
double power_series(Parameters a, double x) {
  double sum = 0;
  for (std::size_t i = a.size(); i-- > 0;) sum = (sum + a[i]) * x;
  return sum;
}

// Tangential distortion (Brown): added to the radially distorted point.
Vector2d tangential(const Vector2d& p, double p1, double p2) {
  const double r2 = p.squaredNorm(), xy = p.x() * p.y();
  return {2 * p1 * xy + p2 * (r2 + 2 * p.x() * p.x()), 2 * p2 * xy + p1 * (r2 + 2 * p.y() * p.y())};
}

Vector2d pinhole(Parameters, const Vector2d& p) {
  return p;
}

Vector2d radial(Parameters k, const Vector2d& p) {
  return p * (1 + power_series(k, p.squaredNorm()));
}

Vector2d opencv(Parameters k, const Vector2d& p) {
  return radial(k.first(2), p) + tangential(p, k[2], k[3]);
}

Vector2d full_opencv(Parameters k, const Vector2d& p) {
  const double r2 = p.squaredNorm();
  const std::array<double, 3> above{k[0], k[1], k[4]};
  const double ratio = (1 + power_series(above, r2)) / (1 + power_series(k.subspan(5, 3), r2));
  return p * ratio + tangential(p, k[2], k[3]);
}

// The point at the distance theta from the centre, in the direction of p: the equidistant fisheye.
Vector2d equidistant(const Vector2d& p) {
  const double r = p.norm();
  return r > 0 ? Vector2d(p * (std::atan(r) / r)) : p;
}

Vector2d fisheye(Parameters k, const Vector2d& p) {
  return radial(k, equidistant(p));
}

Vector2d thin_prism_fisheye(Parameters k, const Vector2d& p) {
  const Vector2d e = equidistant(p);
  const double r2 = e.squaredNorm();
  const std::array<double, 4> series{k[0], k[1], k[4], k[5]};
  return radial(series, e) + tangential(e, k[2], k[3]) + Vector2d(k[6], k[7]) * r2;
}

Vector2d rad_tan_thin_prism_fisheye(Parameters k, const Vector2d& p) {
  const Vector2d e = radial(k.first(6), equidistant(p));
  const double r2 = e.squaredNorm();
  // The model's first tangential parameter has the role of Brown's second.
  return e + tangential(e, k[7], k[6]) + Vector2d(k[8], k[10]) * r2 +
         Vector2d(k[9], k[11]) * r2 * r2;
}

Vector2d field_of_view(Parameters k, const Vector2d& p) {
  const double omega = k[0], r = p.norm();
  if (omega == 0 || r == 0) return p;
  return p * (std::atan(2 * r * std::tan(omega / 2)) / (omega * r));
}

// Division model: undistorted = distorted / (1 + k r_distorted^2), solved for the distorted point.
Vector2d division(Parameters k, const Vector2d& p) {
  return p * (2 / (1 + std::sqrt(1 - 4 * k[0] * p.squaredNorm())));
}

// Enhanced unified camera model; (alpha, beta) = (0, 1) is the pinhole.
Vector2d eucm(Parameters k, const Vector2d& p) {
  const double below = k[0] * std::sqrt(k[1] * p.squaredNorm() + 1) + 1 - k[0];
  return below > 0 ? Vector2d(p / below) : Vector2d::Constant(std::nan(""));
}

// The same models in the matcher's form. One function handles related models: OPENCV is FULL_OPENCV
// without the last four parameters, for example. Missing parameters are zero.
double at(Parameters k, std::size_t i) {
  return i < k.size() ? k[i] : 0;
}

Bent bent_radially(Parameters k) {
  Bent bent;
  for (std::size_t i = 0; i < 4; ++i) bent.above[i + 1] = at(k, i);
  return bent;
}

Bent bent_as_opencv(Parameters k) {
  Bent bent;
  bent.above = {1, k[0], k[1], at(k, 4), 0};
  bent.below = {at(k, 5), at(k, 6), at(k, 7)};
  bent.p1 = k[2];
  bent.p2 = k[3];
  return bent;
}

Bent bent_as_fisheye(Parameters k) {
  Bent bent = bent_radially(k);
  bent.fisheye = 1;
  return bent;
}

Bent bent_as_thin_prism_fisheye(Parameters k) {
  Bent bent;
  bent.fisheye = 1;
  bent.above = {1, k[0], k[1], k[4], k[5]};
  bent.p1 = k[2];
  bent.p2 = k[3];
  bent.prism = {k[6], k[7]};
  return bent;
}

Bent bent_by_field_of_view(Parameters k) {
  Bent bent;
  const double omega = std::abs(k[0]);  // the model is even in it
  if (omega == 0) return bent;
  bent.fisheye = 1;
  bent.spread = 2 * std::tan(omega / 2);
  bent.above[0] = 1 / omega;
  return bent;
}

constexpr std::array kModels = {
    Model{"SIMPLE_PINHOLE", pinhole, true},
    Model{"PINHOLE", pinhole, true},
    Model{"SIMPLE_RADIAL", radial, true, bent_radially},
    Model{"RADIAL", radial, true, bent_radially},
    Model{"OPENCV", opencv, true, bent_as_opencv},
    Model{"FULL_OPENCV", full_opencv, true, bent_as_opencv},
    Model{"OPENCV_FISHEYE", fisheye, false, bent_as_fisheye},
    Model{"SIMPLE_RADIAL_FISHEYE", fisheye, false, bent_as_fisheye},
    Model{"RADIAL_FISHEYE", fisheye, false, bent_as_fisheye},
    Model{"SIMPLE_FISHEYE", fisheye, false, bent_as_fisheye},
    Model{"FISHEYE", fisheye, false, bent_as_fisheye},
    Model{"THIN_PRISM_FISHEYE", thin_prism_fisheye, false, bent_as_thin_prism_fisheye},
    Model{"RAD_TAN_THIN_PRISM_FISHEYE", rad_tan_thin_prism_fisheye, false},
    Model{"FOV", field_of_view, true, bent_by_field_of_view},
    Model{"SIMPLE_DIVISION", division, true, nullptr, true},
    Model{"DIVISION", division, true, nullptr, true},
    Model{"EUCM", eucm, false, nullptr, true},
};

}  // namespace

const Model* find_model(std::string_view name) {
  const auto found = std::ranges::find(kModels, name, &Model::name);
  return found == kModels.end() ? nullptr : &*found;
}

}  // namespace axial::lens
