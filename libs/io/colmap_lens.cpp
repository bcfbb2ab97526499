// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap_lens.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>

#include "base/error.h"
#include "io/lens_fit.h"

namespace axial::io {

namespace {

using Eigen::Vector2d;
using Parameters = std::span<const double>;  // distortion parameters only

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
using Bent = refractive::LensDistortion<double>;

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

struct Lens {
  std::string_view model;
  int focal_lengths;  // 1: f cx cy ..., 2: fx fy cx cy ...
  Vector2d (*distort)(Parameters, const Vector2d&);
  bool flat;                   // a pinhole if all distortion parameters are zero
  Bent (*bent)(Parameters){};  // null: the matcher does not have this model
  bool radial = false;         // the matcher's fisheye can be fitted to the model
};

constexpr std::array kLenses = {
    Lens{"SIMPLE_PINHOLE", 1, pinhole, true},
    Lens{"PINHOLE", 2, pinhole, true},
    Lens{"SIMPLE_RADIAL", 1, radial, true, bent_radially},
    Lens{"RADIAL", 1, radial, true, bent_radially},
    Lens{"OPENCV", 2, opencv, true, bent_as_opencv},
    Lens{"FULL_OPENCV", 2, full_opencv, true, bent_as_opencv},
    Lens{"OPENCV_FISHEYE", 2, fisheye, false, bent_as_fisheye},
    Lens{"SIMPLE_RADIAL_FISHEYE", 1, fisheye, false, bent_as_fisheye},
    Lens{"RADIAL_FISHEYE", 1, fisheye, false, bent_as_fisheye},
    Lens{"SIMPLE_FISHEYE", 1, fisheye, false, bent_as_fisheye},
    Lens{"FISHEYE", 2, fisheye, false, bent_as_fisheye},
    Lens{"THIN_PRISM_FISHEYE", 2, thin_prism_fisheye, false, bent_as_thin_prism_fisheye},
    Lens{"RAD_TAN_THIN_PRISM_FISHEYE", 2, rad_tan_thin_prism_fisheye, false},
    Lens{"FOV", 2, field_of_view, true, bent_by_field_of_view},
    Lens{"SIMPLE_DIVISION", 1, division, true, nullptr, true},
    Lens{"DIVISION", 2, division, true, nullptr, true},
    Lens{"EUCM", 2, eucm, false, nullptr, true},
};

// COLMAP-Underwater's own model, which COLMAP cannot undistort.
constexpr std::string_view kNotColmaps = "METASHAPE_FISHEYE";

// A camera's parameters in parts: focal lengths and principal point (pixel centres at integers),
// and distortion.
struct Parts {
  const Lens* lens;
  refractive::PinholeLens<double> pinhole;
  Parameters distortion;
};

Parts take_apart(const ColmapCamera& camera) {
  const auto lens = std::find_if(kLenses.begin(), kLenses.end(),
                                 [&](const Lens& l) { return l.model == camera.model; });
  if (lens == kLenses.end())
    fail("camera {}: model {} is not supported; undistort its images with {} first", camera.id,
         camera.model, camera.model == kNotColmaps ? "the program that calibrated it" : "COLMAP");
  const Parameters p(camera.params);
  if (static_cast<int>(p.size()) != colmap_parameter_count(camera.model))
    fail("camera {}: model {} has {} parameters, not {}", camera.id, camera.model,
         colmap_parameter_count(camera.model), p.size());
  const std::size_t n = static_cast<std::size_t>(lens->focal_lengths);
  return {&*lens, {p[0], p[n - 1], p[n] - 0.5, p[n + 1] - 0.5}, p.subspan(n + 2)};
}

Vector2d image_point(const Parts& parts, const Vector2d& direction) {
  const Vector2d p = parts.lens->distort(parts.distortion, direction);
  return {parts.pinhole.fx * p.x() + parts.pinhole.cx, parts.pinhole.fy * p.y() + parts.pinhole.cy};
}

bool inside(const ColmapCamera& camera, const Vector2d& pixel) {
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= static_cast<double>(camera.width) - 1 &&
         pixel.y() <= static_cast<double>(camera.height) - 1;  // false for NaN
}

// True if the distance of the image from the principal point grows from the axis up to `direction`.
// Polynomials fold back beyond the field to which they were fitted, and a folded ray can be imaged
// inside the picture again. `wanted` must be true for every pixel on the way.
template <class Wanted>
bool grows_until(const Parts& parts, const Vector2d& direction, const Wanted& wanted) {
  constexpr int kSteps = 50;
  const Vector2d centre = image_point(parts, Vector2d::Zero());
  if (direction.isZero(0)) return wanted(centre);
  double distance = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const Vector2d pixel = image_point(parts, direction * (double(i) / kSteps));
    const double next = (pixel - centre).norm();
    if (!wanted(pixel) || !(next > distance)) return false;
    distance = next;
  }
  // The steps are coarse. A fold within the last step is visible only in the slope at its end.
  const Vector2d beyond = image_point(parts, direction * (1 + 1e-6));
  return (beyond - centre).norm() > distance;
}

bool seen(const ColmapCamera& camera, const Parts& parts, const Vector2d& direction) {
  return grows_until(parts, direction,
                     [&](const Vector2d& pixel) { return inside(camera, pixel); });
}

bool whole_border_seen(const ColmapCamera& camera, const Parts& parts,
                       const refractive::PinholeLens<double>& lens) {
  const double right = static_cast<double>(camera.width) - 1;
  const double bottom = static_cast<double>(camera.height) - 1;
  constexpr int kSamples = 64;
  for (int i = 0; i <= kSamples; ++i) {
    const double x = right * i / kSamples, y = bottom * i / kSamples;
    for (const Vector2d& pixel :
         {Vector2d(x, 0), Vector2d(x, bottom), Vector2d(0, y), Vector2d(right, y)})
      if (!seen(camera, parts, {(pixel.x() - lens.cx) / lens.fx, (pixel.y() - lens.cy) / lens.fy}))
        return false;
  }
  return true;
}

// Central differences, because the models share no closed-form derivative.
Eigen::Matrix2d derivative_at(const Parts& parts, const Vector2d& direction) {
  const double h = 1e-6 * (1 + direction.norm());
  Eigen::Matrix2d derivative;
  for (int k = 0; k < 2; ++k) {
    const Vector2d step = h * Vector2d::Unit(k);
    derivative.col(k) =
        (image_point(parts, direction + step) - image_point(parts, direction - step)) / (2 * h);
  }
  return derivative;
}

}  // namespace

std::optional<ImagedDirection> direction_at(const ColmapCamera& camera, const Vector2d& pixel) {
  const Parts parts = take_apart(camera);
  const auto& lens = parts.pinhole;
  Vector2d direction((pixel.x() - lens.cx) / lens.fx, (pixel.y() - lens.cy) / lens.fy);
  constexpr int kSteps = 50;
  for (int i = 0; i < kSteps; ++i) {
    const Vector2d miss = image_point(parts, direction) - pixel;
    const Eigen::Matrix2d derivative = derivative_at(parts, direction);
    if (!miss.allFinite() || !(derivative.determinant() > 0)) return std::nullopt;
    if (miss.norm() < 1e-9 * (1 + pixel.norm())) {
      const auto any = [](const Vector2d&) { return true; };
      if (!grows_until(parts, direction, any)) return std::nullopt;
      return ImagedDirection{direction - derivative.inverse() * miss, derivative};
    }
    Vector2d step = derivative.inverse() * miss;
    // The edge of a fisheye is far out on the plane z = 1, so the step length is limited.
    const double reach = 0.5 * (1 + direction.norm());
    if (step.norm() > reach) step *= reach / step.norm();
    direction -= step;
  }
  return std::nullopt;
}

refractive::PinholeLens<double> undistorted_lens(const ColmapCamera& camera) {
  return take_apart(camera).pinhole;
}

Vector2d image_direction(const ColmapCamera& camera, double u, double v) {
  return image_point(take_apart(camera), {u, v});
}

namespace {

// The largest angle of an image corner from the axis [rad], at most 85 degrees, which is as far as
// the matcher follows a lens. Corners that no direction projects to count as 85 degrees.
double widest_angle(const ColmapCamera& camera) {
  constexpr double kWidest = 85 * std::numbers::pi / 180;
  const double right = static_cast<double>(camera.width) - 1;
  const double bottom = static_cast<double>(camera.height) - 1;
  double widest = 0;
  for (const Vector2d& corner :
       {Vector2d(0, 0), Vector2d(right, 0), Vector2d(0, bottom), Vector2d(right, bottom)}) {
    const auto imaged = direction_at(camera, corner);
    widest = std::max(widest, imaged ? std::atan(imaged->direction.norm()) : kWidest);
  }
  return std::min(widest, kWidest);
}

// The tolerance is a tenth of the rounding error of a pixel in the matcher's single precision.
std::optional<Bent> fitted(const ColmapCamera& camera, const Parts& parts) {
  constexpr double kPixels = 1e-4;
  const auto radius = [&](double theta) {
    return parts.lens->distort(parts.distortion, {std::tan(theta), 0}).x();
  };
  return fitted_fisheye(radius, widest_angle(camera),
                        kPixels / std::max(parts.pinhole.fx, parts.pinhole.fy));
}

}  // namespace

std::optional<refractive::LensDistortion<double>> lens_distortion(const ColmapCamera& camera) {
  const Parts parts = take_apart(camera);
  if (pinhole_lens(camera)) return std::nullopt;
  if (parts.lens->bent) return parts.lens->bent(parts.distortion);
  return parts.lens->radial ? fitted(camera, parts) : std::nullopt;
}

std::optional<refractive::PinholeLens<double>> pinhole_lens(const ColmapCamera& camera) {
  const Parts parts = take_apart(camera);
  const bool straight = std::all_of(parts.distortion.begin(), parts.distortion.end(),
                                    [](double k) { return k == 0; });
  if (!parts.lens->flat || !straight) return std::nullopt;
  return parts.pinhole;
}

refractive::PinholeLens<double> pinhole_inside(const ColmapCamera& camera,
                                               const std::string& name) {
  const Parts parts = take_apart(camera);
  const auto zoomed = [&](double zoom) {
    auto lens = parts.pinhole;
    lens.fx *= zoom;
    lens.fy *= zoom;
    return lens;
  };
  double narrow = 4, wide = 0.5;
  if (!whole_border_seen(camera, parts, zoomed(narrow)))
    fail(
        "{}: camera {} ({}) cannot be undistorted: its image covers less than a quarter of a "
        "pinhole image",
        name, camera.id, camera.model);
  if (whole_border_seen(camera, parts, zoomed(wide))) return zoomed(wide);
  for (int i = 0; i < 40; ++i) {
    const double middle = (narrow + wide) / 2;
    (whole_border_seen(camera, parts, zoomed(middle)) ? narrow : wide) = middle;
  }
  return zoomed(narrow);
}

cv::Mat2f undistortion_map(const ColmapCamera& camera,
                           const refractive::PinholeLens<double>& pinhole) {
  const Parts parts = take_apart(camera);
  cv::Mat2f map(static_cast<int>(camera.height), static_cast<int>(camera.width));
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.cols; ++x) {
      const Vector2d direction((x - pinhole.cx) / pinhole.fx, (y - pinhole.cy) / pinhole.fy);
      const Vector2d pixel = image_point(parts, direction);
      map(y, x) = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
    }
  return map;
}

}  // namespace axial::io
