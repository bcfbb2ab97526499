// SPDX-License-Identifier: GPL-3.0-or-later
#include "lens/models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace axial::lens {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Imaged = refractive::PlanePoint<double>;
using Bent = refractive::LensDistortion<double>;

// The value of a function of one variable, and its derivative.
struct Slope {
  double value, slope;
};

// 1 + a[0] x + a[1] x^2 + ...
Slope power_series(Parameters a, double x) {
  Slope sum{0, 0};
  for (std::size_t i = a.size(); i-- > 0;)
    sum = {(sum.value + a[i]) * x, sum.slope * x + (sum.value + a[i])};
  return {1 + sum.value, sum.slope};
}

// p factor(s) with s = |p|^2.
Imaged scaled(const Vector2d& p, const Slope& factor) {
  const Matrix2d along = (2 * factor.slope * p) * p.transpose();
  return {p * factor.value, factor.value * Matrix2d::Identity() + along};
}

// `outer` maps the point of `inner`.
Imaged chain(const Imaged& outer, const Imaged& inner) {
  return {outer.point, outer.by * inner.by};
}

// Both map the same point.
Imaged sum(const Imaged& a, const Imaged& b) {
  return {a.point + b.point, a.by + b.by};
}

// Tangential distortion (Brown): added to the radially distorted point.
Imaged tangential(const Vector2d& p, double p1, double p2) {
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm(), xy = x * y;
  Imaged shift;
  shift.point = {2 * p1 * xy + p2 * (r2 + 2 * x * x), 2 * p2 * xy + p1 * (r2 + 2 * y * y)};
  const double across = 2 * (p1 * x + p2 * y);
  shift.by << 2 * p1 * y + 6 * p2 * x, across, across, 2 * p2 * x + 6 * p1 * y;
  return shift;
}

// direction * factor(s) with s = |p|^2.
Imaged prism(const Vector2d& p, const Vector2d& direction, const Slope& factor) {
  return {direction * factor.value, (2 * factor.slope * direction) * p.transpose()};
}

Imaged pinhole(Parameters, const Vector2d& p) {
  return {p, Matrix2d::Identity()};
}

Imaged radial(Parameters k, const Vector2d& p) {
  return scaled(p, power_series(k, p.squaredNorm()));
}

Imaged opencv(Parameters k, const Vector2d& p) {
  return sum(radial(k.first(2), p), tangential(p, k[2], k[3]));
}

Imaged full_opencv(Parameters k, const Vector2d& p) {
  const double r2 = p.squaredNorm();
  const std::array<double, 3> coefficients{k[0], k[1], k[4]};
  const Slope above = power_series(coefficients, r2), below = power_series(k.subspan(5, 3), r2);
  const double ratio = above.value / below.value;
  const Slope factor{ratio, (above.slope - ratio * below.slope) / below.value};
  return sum(scaled(p, factor), tangential(p, k[2], k[3]));
}

// p atan(spread r) / (unit r) with r = |p|.
Imaged by_angle(const Vector2d& p, double spread, double unit) {
  const double r2 = p.squaredNorm(), r = std::sqrt(r2);
  if (!(r2 > 0)) return scaled(p, {spread / unit, 0});
  const double factor = std::atan(spread * r) / (unit * r);
  return scaled(p, {factor, (spread / (unit * (1 + spread * spread * r2)) - factor) / (2 * r2)});
}

// The point at the distance theta from the centre, in the direction of p: the equidistant fisheye.
Imaged equidistant(const Vector2d& p) {
  return by_angle(p, 1, 1);
}

Imaged fisheye(Parameters k, const Vector2d& p) {
  const Imaged e = equidistant(p);
  return chain(radial(k, e.point), e);
}

Imaged thin_prism_fisheye(Parameters k, const Vector2d& p) {
  const Imaged e = equidistant(p);
  const std::array<double, 4> series{k[0], k[1], k[4], k[5]};
  const Imaged bent = sum(radial(series, e.point), tangential(e.point, k[2], k[3]));
  const Slope square{e.point.squaredNorm(), 1};
  return chain(sum(bent, prism(e.point, {k[6], k[7]}, square)), e);
}

Imaged rad_tan_thin_prism_fisheye(Parameters k, const Vector2d& p) {
  const Imaged angle = equidistant(p);
  const Imaged e = chain(radial(k.first(6), angle.point), angle);
  const double r2 = e.point.squaredNorm();
  // The model's first tangential parameter has the role of Brown's second.
  const Imaged shift = tangential(e.point, k[7], k[6]);
  const Imaged prisms =
      sum(prism(e.point, {k[8], k[10]}, {r2, 1}), prism(e.point, {k[9], k[11]}, {r2 * r2, 2 * r2}));
  return sum(e, chain(sum(shift, prisms), e));
}

Imaged field_of_view(Parameters k, const Vector2d& p) {
  const double omega = k[0];
  if (omega == 0) return pinhole(k, p);
  return by_angle(p, 2 * std::tan(omega / 2), omega);
}

// Division model: undistorted = distorted / (1 + k r_distorted^2), solved for the distorted point.
Imaged division(Parameters k, const Vector2d& p) {
  const double root = std::sqrt(1 - 4 * k[0] * p.squaredNorm());
  return scaled(p, {2 / (1 + root), 4 * k[0] / (root * (1 + root) * (1 + root))});
}

// Enhanced unified camera model; (alpha, beta) = (0, 1) is the pinhole.
Imaged eucm(Parameters k, const Vector2d& p) {
  const double root = std::sqrt(k[1] * p.squaredNorm() + 1);
  const double below = k[0] * root + 1 - k[0];
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!(below > 0)) return {Vector2d::Constant(kNone), Matrix2d::Constant(kNone)};
  return scaled(p, {1 / below, -k[0] * k[1] / (2 * root * below * below)});
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

namespace {

// The models with polynomials. The first coefficient above is 1, and the spread is 1.
std::optional<ModelOf> polynomial_of(const Bent& bent) {
  const auto& a = bent.above;
  const auto& b = bent.below;
  const bool ratio = b != std::array<double, 3>{}, tangential = bent.p1 != 0 || bent.p2 != 0;
  const bool prism = !bent.prism.isZero(0);
  if (bent.fisheye == 0) {
    if (prism || a[4] != 0) return {};
    if (!ratio && a[3] == 0) return ModelOf{"OPENCV", {a[1], a[2], bent.p1, bent.p2}};
    return ModelOf{"FULL_OPENCV", {a[1], a[2], bent.p1, bent.p2, a[3], b[0], b[1], b[2]}};
  }
  if (ratio) return {};
  if (!prism && !tangential) return ModelOf{"OPENCV_FISHEYE", {a[1], a[2], a[3], a[4]}};
  return ModelOf{"THIN_PRISM_FISHEYE",
                 {a[1], a[2], bent.p1, bent.p2, a[3], a[4], bent.prism.x(), bent.prism.y()}};
}

}  // namespace

std::optional<ModelOf> model_of(const Bent& bent) {
  const double first = bent.above[0];
  Bent rest = bent;  // without the first coefficient, which the focal lengths take
  for (double& a : rest.above) a /= first;
  rest.p1 /= first;
  rest.p2 /= first;
  rest.prism /= first;
  std::optional<ModelOf> found;
  if (bent.spread == 1) {
    found = polynomial_of(rest);
    if (found) found->focal_factor = first;
    return found;
  }
  rest.spread = 1;
  if (bent.fisheye == 0 || !(rest == bent_as_fisheye({}))) return {};
  const double omega = 2 * std::atan(bent.spread / 2);
  // Rounding must not change the focal lengths of a FOV camera that is written and read again.
  const double factor = first * omega;
  return ModelOf{"FOV", {omega}, std::abs(factor - 1) < 1e-14 ? 1 : factor};
}

}  // namespace axial::lens
