// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/photograph_camera.h"

#include <limits>
#include <utility>

namespace axial::pose {
namespace {

refractive::WidenedImage<double> widened(const lens::Lens& lens) {
  using Image = refractive::WidenedImage<double>;
  constexpr int kDefault = -1;
  return {lens.width, lens.height, Image::margin_or_default(lens.width, lens.height, kDefault)};
}

}  // namespace

PhotographCamera::PhotographCamera(HousedCamera camera)
    : camera_(std::move(camera)),
      inner_(make_tangent_camera(camera_.port, camera_.field.corner)),
      widened_(widened(camera_.lens)),
      principal_point_(camera_.lens.pinhole.cx, camera_.lens.pinhole.cy) {}

PhotographImage PhotographCamera::image(const Eigen::Vector3d& X) const {
  PhotographImage image;
  const auto seen = std::visit(
      [&](const auto& inner) { return inner.project(X, &image.tangents_by_point, &image.origin); },
      inner_);
  image.tangents = seen.pixel;
  const double reach = camera_.field.reach;
  if (!seen.visible || !(image.tangents.squaredNorm() <= reach * reach)) return image;
  const auto at = image_with_derivative(camera_.lens, image.tangents);
  image.pixel = at.point;
  image.by_tangents = at.by;
  image.visible = at.by.determinant() > 0 && widened_.contains(image.pixel);
  return image;
}

refractive::AxialRay<double> PhotographCamera::ray(const Eigen::Vector2d& pixel) const {
  const auto imaged = direction_at(camera_.lens, camera_.field, pixel);
  if (!imaged) {
    const Eigen::Vector3d none =
        Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    return {none, none};
  }
  return std::visit([&](const auto& inner) { return inner.ray(imaged->direction); }, inner_);
}

}  // namespace axial::pose
