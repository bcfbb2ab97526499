// SPDX-License-Identifier: GPL-3.0-or-later
// Maps the reference window to a source view under a plane hypothesis.
#pragma once

#include <Eigen/Core>

#include "axial/scene.h"
#include "depth/patch/patch.h"
#include "depth/patch/zncc.h"
#include "depth/plane_map.h"
#include "refractive/affine_warp.h"
#include "refractive/axial_ray.h"
#include "refractive/virtual_camera.h"

namespace axial::depth {

// The transformation of points [m] from the reference camera's frame to the source camera's frame:
// x_in_source = rotation * x_in_reference + translation.
struct RelativePose {
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
  Eigen::Vector3f translation = Eigen::Vector3f::Zero();

  RelativePose() = default;
  RelativePose(const Pose& reference, const Pose& source)
      : rotation((source.rotation * reference.rotation.transpose()).cast<float>()),
        translation((source.rotation * (reference.centre - source.centre)).cast<float>()) {}

  Eigen::Vector3f apply(const Eigen::Vector3f& x) const { return rotation * x + translation; }
};

// The point [m] in which the ray of the reference pixel, the centre of the window, meets the plane
// of a hypothesis, and the derivative of this point by the pixel (u, v) [m/px]. Both are in the
// reference camera's frame.
struct PatchDerivative {
  Eigen::Vector3f point;
  refractive::Matrix32<float> by_pixel;
};

// `ray`, `jacobian`: the ray of the reference pixel and its derivatives, in the reference camera's
// frame.
inline PatchDerivative patch_derivative(const refractive::AxialRay<float>& ray,
                                        const refractive::AxialRayJacobian<float>& jacobian,
                                        const PlaneHypothesis& plane) {
  return {ray.at(plane.depth),
          refractive::plane_point_derivative(ray, jacobian, plane.depth, plane.normal)};
}

// A warp policy has two functions. `between` computes the Map of a hypothesis and a source view.
// Its arguments are the reference camera, the reference pixel, the plane and its PatchDerivative,
// the source camera and the RelativePose. `texels` computes the positions of the texels in the
// source view from this Map and the reference pixel. Precondition of `texels`: Map::visible. The
// functions are separate, so that the projections into several views can run in parallel in the
// processor.

// The exact projection of the centre and the exact first derivative (docs/refraction.md, "The
// warp"). Needs no division per texel.
struct AffineWarp {
  struct Map {
    Eigen::Vector2f centre;  // image of the surface point in the source view [px]
    bool visible;            // false: the other members have no meaning
    Eigen::Matrix2f linear;  // source pixels per reference pixel
  };

  template <class Camera>
  static Map between(const Camera&, const Eigen::Vector2f&, const PlaneHypothesis&,
                     const PatchDerivative& patch, const Camera& source,
                     const RelativePose& from_reference) {
    refractive::Matrix23<float> jacobian;
    const auto image = source.project(from_reference.apply(patch.point), &jacobian);
    return {image.pixel, image.visible,
            refractive::warp_derivative(jacobian, from_reference.rotation, patch.by_pixel)};
  }

  static void texels(const Map& map, const Eigen::Vector2f&, TexelPositions& at) {
    const Eigen::Matrix2f& a = map.linear;
    for (std::size_t k = 0; k < kPaddedTexels; ++k) {
      at.x[k] = map.centre.x() + a(0, 0) * kTexelOffsets.x[k] + a(0, 1) * kTexelOffsets.y[k];
      at.y[k] = map.centre.y() + a(1, 0) * kTexelOffsets.x[k] + a(1, 1) * kTexelOffsets.y[k];
    }
  }
};

// The paper's warp (eqs. 1-3): the homography between two virtual cameras. These are the virtual
// camera of the reference pixel and the virtual camera of the source pixel, rounded to integers.
// For pinhole cameras this is the usual homography of a plane.
struct HomographyWarp {
  struct Map {
    Eigen::Vector2f centre;      // image of the surface point in the source view [px], not rounded
    bool visible;                // false: the other members have no meaning
    Eigen::Matrix3f homography;  // from the reference pixel to the source pixel, homogeneous
  };

  template <class Camera>
  static Map between(const Camera& reference, const Eigen::Vector2f& pixel,
                     const PlaneHypothesis& plane, const PatchDerivative& patch,
                     const Camera& source, const RelativePose& from_reference) {
    const auto image = source.project(from_reference.apply(patch.point));
    const Eigen::Vector2f rounded = image.pixel.array().round();
    const Eigen::Vector3f source_centre =
        -(from_reference.rotation.transpose() * from_reference.translation);
    return {image.pixel, image.visible,
            refractive::virtual_homography<float>(refractive::virtual_camera(reference, pixel),
                                                  refractive::virtual_camera(source, rounded),
                                                  from_reference.rotation, source_centre,
                                                  patch.point, plane.normal)};
  }

  static void texels(const Map& map, const Eigen::Vector2f& pixel, TexelPositions& at) {
    for (std::size_t k = 0; k < kPaddedTexels; ++k) {
      const Eigen::Vector2f texel(pixel.x() + kTexelOffsets.x[k], pixel.y() + kTexelOffsets.y[k]);
      const Eigen::Vector2f image = refractive::apply_homography(map.homography, texel);
      at.x[k] = image.x();
      at.y[k] = image.y();
    }
  }
};

}  // namespace axial::depth
