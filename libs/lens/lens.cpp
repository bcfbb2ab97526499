// SPDX-License-Identifier: GPL-3.0-or-later
#include "lens/lens.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lens/lens_fit.h"

namespace axial::lens {
namespace {

using Eigen::Vector2d;
using Imaged = refractive::PlanePoint<double>;

Vector2d image_point(const Lens& lens, const Vector2d& direction) {
  return image_with_derivative(lens, direction).point;
}

bool inside(const Lens& lens, const Vector2d& pixel) {
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= lens.width - 1.0 &&
         pixel.y() <= lens.height - 1.0;  // false for NaN
}

// True if the distance of the image from the principal point grows from the axis up to `direction`.
// Polynomials fold back beyond the field to which they were fitted, and a folded ray can be imaged
// inside the picture again. `wanted` must be true for every pixel on the way.
template <class Wanted>
bool grows_until(const Lens& lens, const Vector2d& direction, const Wanted& wanted) {
  constexpr int kSteps = 50;
  const Vector2d centre = image_point(lens, Vector2d::Zero());
  if (direction.isZero(0)) return wanted(centre);
  double distance = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const Vector2d pixel = image_point(lens, direction * (double(i) / kSteps));
    const double next = (pixel - centre).norm();
    if (!wanted(pixel) || !(next > distance)) return false;
    distance = next;
  }
  // The steps are coarse. A fold within the last step is visible only in the slope at its end.
  const Vector2d beyond = image_point(lens, direction * (1 + 1e-6));
  return (beyond - centre).norm() > distance;
}

bool seen(const Lens& lens, const Vector2d& direction) {
  return grows_until(lens, direction, [&](const Vector2d& pixel) { return inside(lens, pixel); });
}

bool whole_border_seen(const Lens& lens, const refractive::PinholeLens<double>& pinhole) {
  const double right = lens.width - 1.0;
  const double bottom = lens.height - 1.0;
  constexpr int kSamples = 64;
  for (int i = 0; i <= kSamples; ++i) {
    const double x = right * i / kSamples, y = bottom * i / kSamples;
    for (const Vector2d& pixel :
         {Vector2d(x, 0), Vector2d(x, bottom), Vector2d(0, y), Vector2d(right, y)})
      if (!seen(lens,
                {(pixel.x() - pinhole.cx) / pinhole.fx, (pixel.y() - pinhole.cy) / pinhole.fy}))
        return false;
  }
  return true;
}

// Solves for the direction by Newton's method, from the direction of the undistorted lens. The
// result may lie beyond a fold of the lens.
std::optional<ImagedDirection> solved_direction(const Lens& lens, const Vector2d& pixel) {
  const auto& pinhole = lens.pinhole;
  Vector2d direction((pixel.x() - pinhole.cx) / pinhole.fx, (pixel.y() - pinhole.cy) / pinhole.fy);
  constexpr int kSteps = 50;
  for (int i = 0; i < kSteps; ++i) {
    const Imaged at = image_with_derivative(lens, direction);
    const Vector2d miss = at.point - pixel;
    if (!miss.allFinite() || !(at.by.determinant() > 0)) return std::nullopt;
    Vector2d step = at.by.inverse() * miss;
    if (miss.norm() < 1e-9 * (1 + pixel.norm())) return ImagedDirection{direction - step, at.by};
    // The edge of a fisheye is far out on the plane z = 1, so the step length is limited.
    const double reach = 0.5 * (1 + direction.norm());
    if (step.norm() > reach) step *= reach / step.norm();
    direction -= step;
  }
  return std::nullopt;
}

// The largest angle [rad] from the axis up to which directions that lie on the side of `side`, a
// unit vector, move outwards in the image as the angle grows.
double growing_angle(const Lens& lens, const Vector2d& side) {
  const Vector2d centre = image_point(lens, Vector2d::Zero());
  const auto grows = [&](double angle) {
    const Imaged at = image_with_derivative(lens, std::tan(angle) * side);
    return at.by.determinant() > 0 && (at.point - centre).dot(at.by * side) > 0;
  };
  constexpr int kSteps = 90, kHalvings = 40;
  constexpr double kWidest = (1 - 1e-6) * std::numbers::pi / 2;  // has a finite tangent
  double low = 0, high = kWidest;
  for (int i = 1; i <= kSteps && low < kWidest; ++i) {
    const double next = kWidest * i / kSteps;
    if (!grows(next)) {
      high = next;
      break;
    }
    low = next;
  }
  for (int i = 0; i < kHalvings && low < high; ++i) {
    const double middle = (low + high) / 2;
    (grows(middle) ? low : high) = middle;
  }
  return low;
}

// The largest angle of an image corner from the axis [rad], at most 85 degrees, which is as far as
// the matcher follows a lens. Corners that no direction projects to count as 85 degrees.
double widest_angle(const Lens& lens) {
  constexpr double kWidest = 85 * std::numbers::pi / 180;
  const double right = lens.width - 1.0;
  const double bottom = lens.height - 1.0;
  double widest = 0;
  for (const Vector2d& corner :
       {Vector2d(0, 0), Vector2d(right, 0), Vector2d(0, bottom), Vector2d(right, bottom)}) {
    const auto imaged = direction_at(lens, corner);
    widest = std::max(widest, imaged ? std::atan(imaged->direction.norm()) : kWidest);
  }
  return std::min(widest, kWidest);
}

// The tolerance is a tenth of the rounding error of a pixel in the matcher's single precision.
std::optional<refractive::LensDistortion<double>> fitted(const Lens& lens) {
  constexpr double kPixels = 1e-4;
  const auto radius = [&](double theta) {
    return lens.model->distort(lens.distortion, {std::tan(theta), 0}).point.x();
  };
  return fitted_fisheye(radius, widest_angle(lens),
                        kPixels / std::max(lens.pinhole.fx, lens.pinhole.fy));
}

}  // namespace

Vector2d image_direction(const Lens& lens, double u, double v) {
  return image_point(lens, {u, v});
}

refractive::PlanePoint<double> image_with_derivative(const Lens& lens, const Vector2d& direction) {
  const auto& pinhole = lens.pinhole;
  Imaged at = lens.model->distort(lens.distortion, direction);
  at.point = {pinhole.fx * at.point.x() + pinhole.cx, pinhole.fy * at.point.y() + pinhole.cy};
  at.by.row(0) *= pinhole.fx;
  at.by.row(1) *= pinhole.fy;
  return at;
}

std::optional<ImagedDirection> direction_at(const Lens& lens, const Vector2d& pixel) {
  const auto found = solved_direction(lens, pixel);
  const auto any = [](const Vector2d&) { return true; };
  if (!found || !grows_until(lens, found->direction, any)) return std::nullopt;
  return found;
}

std::optional<ImagedDirection> direction_at(const Lens& lens, const Field& field,
                                            const Vector2d& pixel) {
  const auto found = solved_direction(lens, pixel);
  if (!found || !(found->direction.norm() <= field.reach)) return std::nullopt;
  return found;
}

Field field_of(const Lens& lens) {
  if (!lens.model) return {};
  constexpr int kSides = 16;
  double angle = 0;
  for (int k = 0; k < kSides; ++k) {
    const double turn = 2 * std::numbers::pi * k / kSides;
    angle = std::max(angle, growing_angle(lens, {std::cos(turn), std::sin(turn)}));
  }
  return {std::tan(angle), std::min(std::tan(widest_angle(lens)), std::tan(angle))};
}

std::optional<refractive::PinholeLens<double>> pinhole_lens(const Lens& lens) {
  const bool straight =
      std::all_of(lens.distortion.begin(), lens.distortion.end(), [](double k) { return k == 0; });
  if (!lens.model->flat || !straight) return std::nullopt;
  return lens.pinhole;
}

std::optional<refractive::LensDistortion<double>> lens_distortion(const Lens& lens) {
  if (pinhole_lens(lens)) return std::nullopt;
  if (lens.model->bent) return lens.model->bent(lens.distortion);
  return lens.model->radial ? fitted(lens) : std::nullopt;
}

std::optional<refractive::PinholeLens<double>> pinhole_inside(const Lens& lens) {
  const auto zoomed = [&](double zoom) {
    auto pinhole = lens.pinhole;
    pinhole.fx *= zoom;
    pinhole.fy *= zoom;
    return pinhole;
  };
  double narrow = 4, wide = 0.5;
  if (!whole_border_seen(lens, zoomed(narrow))) return std::nullopt;
  if (whole_border_seen(lens, zoomed(wide))) return zoomed(wide);
  for (int i = 0; i < 40; ++i) {
    const double middle = (narrow + wide) / 2;
    (whole_border_seen(lens, zoomed(middle)) ? narrow : wide) = middle;
  }
  return zoomed(narrow);
}

cv::Mat2f undistortion_map(const Lens& lens, const refractive::PinholeLens<double>& pinhole) {
  cv::Mat2f map(lens.height, lens.width);
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.cols; ++x) {
      const Vector2d direction((x - pinhole.cx) / pinhole.fx, (y - pinhole.cy) / pinhole.fy);
      const Vector2d pixel = image_point(lens, direction);
      map(y, x) = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
    }
  return map;
}

}  // namespace axial::lens
