// SPDX-License-Identifier: BSD-3-Clause
// The exact forward projection through a flat port, in the port's frame: origin where the axis
// meets the outer plane, z along the port's normal into the water, metres.
#pragma once

#include <cmath>

#include "refractive/flat_port.h"
#include "refractive/flat_port_solver.h"
#include "refractive/pinhole_camera.h"
#include "refractive/widened_image.h"

namespace axial::refractive {

// Rotation from the camera frame to the axis frame (flat_port.h) of a port with the unit normal n.
// Of all rotations that take n to +z, the result has the smallest angle. Precondition: n.z > -1.
template <class T>
Matrix3<T> axis_from_camera(const Vector3<T>& n) {
  const T k = T(1) / (T(1) + n.z());
  Matrix3<T> rotation;
  rotation << T(1) - k * n.x() * n.x(), -k * n.x() * n.y(), -n.x(),  //
      -k * n.x() * n.y(), T(1) - k * n.y() * n.y(), -n.y(),          //
      n.x(), n.y(), n.z();
  return rotation;
}

// Returns the tangent of the largest angle of incidence on the port in air, over the image
// rectangle of width x height pixels, widened by `margin` pixels on every side. The result is
// limited to the range from 0.001 to 50. The result is 50, too, if a corner looks parallel to the
// port or away from the port. Testing the four corners is sufficient, because the pixels below a
// given incidence form a convex set.
template <class T>
T largest_incidence_tangent(const PinholeLens<T>& lens, const FlatPort<T>& port, int width,
                            int height, const T& margin) {
  using std::sqrt;
  const T kGrazing(50);  // 88.9 degrees
  T largest = T(1e-3);
  for (const T& u : {-margin, T(width - 1) + margin}) {
    for (const T& v : {-margin, T(height - 1) + margin}) {
      const Vector3<T> bearing = lens.bearing({u, v});
      const T along = bearing.dot(port.normal);
      if (!(along > T(0))) return kGrazing;
      const Vector3<T> across = bearing - along * port.normal;
      const T tangent2 = across.squaredNorm() / (along * along);
      if (tangent2 > largest * largest) largest = sqrt(tangent2);
    }
  }
  return largest < kGrazing ? largest : kGrazing;
}

// The image of a point (x, y, z), and the derivative of the pixel by the point. Points and
// directions are in the port's frame. Let rho be the point's distance from the axis, and t its
// in-air tangent (flat_port_solver.h). The in-air direction of the point is
// (x t/rho, y t/rho, 1).
template <class T>
struct FlatPortImage {
  Projection<T> projection;
  T origin_height;  // z of the virtual centre C_v [m]

  // The origin of the ray through the point: the virtual centre C_v [port's frame, m].
  Vector3<T> origin() const { return {T(0), T(0), origin_height}; }

  // First-order motion of the pixel [px] when the point moves by `step` [port's frame, m]. A motion
  // of the point perpendicular to the axis and to the radius changes the in-air direction by t/rho
  // times the motion. A motion along the radius changes the direction by dt/d(rho) times the
  // motion. A motion in +z turns the direction towards the axis.
  Vector2<T> pixel_motion(const Vector3<T>& step) const {
    const T radial = across.x() * step.x() + across.y() * step.y();
    const T outwards = stretch * radial - sink * step.z();
    return lens *
           Vector2<T>(m * step.x() + outwards * across.x(), m * step.y() + outwards * across.y());
  }

  Vector2<T> across;  // the point's x and y [m]
  // Let depth be the camera frame's z of the in-air direction (x t/rho, y t/rho, 1). Then
  // m = t / (rho depth) [1/m], stretch = (dt/d(rho) - t/rho) / (rho^2 depth) [1/m^3] and
  // sink = -(dt/dz) / (rho depth) [1/m^2].
  T m, stretch, sink;
  // Let (a, b, 1) be a direction in air in the port's frame. `lens` is the derivative
  // d(pixel)/d(a, b) [px] at the in-air direction, multiplied by depth. Columns: by a, by b.
  Matrix2<T> lens;
};

// The part of a FlatPortCamera that projects points.
template <class T>
class FlatPortProjector {
 public:
  FlatPortProjector() = default;  // invalid until each_field() has filled it

  // `lens`: the lens in air. `width`, `height`: size of the image [px]. `margin` [px], >= 0: the
  // image is widened by this margin on every side: u from -margin to width - 1 + margin, v from
  // -margin to height - 1 + margin. A point whose image lies outside the widened image is not
  // visible. The preconditions of FlatPort are not checked.
  FlatPortProjector(const PinholeLens<T>& lens, const FlatPort<T>& port, int width, int height,
                    const T& margin)
      : FlatPortProjector(
            lens, port,
            FlatPortField<T>(FlatPortOptics<T>(port),
                             largest_incidence_tangent(lens, port, width, height, margin),
                             largest_incidence_tangent(lens, port, width, height, T(0))),
            WidenedImage<T>(width, height, margin)) {}

  // The projector with a given field and a given image rectangle. A point is visible only if
  // `field` contains the point and `image` [px] contains the pixel of the point. Precondition:
  // `field` was computed for `port`.
  FlatPortProjector(const PinholeLens<T>& lens, const FlatPort<T>& port,
                    const FlatPortField<T>& field, const WidenedImage<T>& image)
      : optics_(port), field_(field), cx_(lens.cx), cy_(lens.cy), image_(image) {
    const Matrix3<T> axis = axis_from_camera(port.normal);
    row_u_ = lens.fx * axis.col(0);
    row_v_ = lens.fy * axis.col(1);
    row_z_ = axis.col(2);
  }

  // Calls visit(number) for every number of the projector, in a fixed order. The SIMD code uses it
  // as it uses FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    optics_.each_field(visit);
    field_.each_field(visit);
    for (Vector3<T>* row : {&row_u_, &row_v_, &row_z_})
      visit(row->x()), visit(row->y()), visit(row->z());
    visit(cx_), visit(cy_);
    image_.each_field(visit);
  }

  // The image of X [port's frame, m]. FlatPortCamera::project states when X is visible. Every
  // number of the result is finite, for every X. The numbers are meaningless if X is not visible.
  FlatPortImage<T> image(const Vector3<T>& X) const {
    FlatPortImage<T> image;
    const T radius2 = X.x() * X.x() + X.y() * X.y();
    const Mask<T> in_field = field_.contains(radius2, X.z());
    // A point outside the field is replaced by a point of the field's edge, so that all results
    // are finite.
    const T z_water = field_.nearest_height(X.z());
    const T rho2 = field_.nearest_rho2(radius2, z_water);
    image.across = {select(in_field, X.x(), T(0)), select(in_field, X.y(), T(0))};
    const FlatPortRoot<T> at = solve_projection(optics_, field_, rho2, z_water);
    // In water, the z of the ray grows by q_w/t metres for every metre of distance from the axis.
    image.origin_height = z_water - T(1) / (at.m * at.inv_qw);

    // Scalar product of a row with the in-air direction.
    const auto along = [&](const Vector3<T>& row) {
      return at.m * (row.x() * image.across.x() + row.y() * image.across.y()) + row.z();
    };
    const T depth = along(row_z_);
    const T kNearest = T(1e-3);
    const Mask<T> in_front = depth > kNearest;
    const T inv_depth = T(1) / greater(depth, kNearest);
    const T u = along(row_u_) * inv_depth;
    const T v = along(row_v_) * inv_depth;
    image.m = at.m * inv_depth;
    // This order of factors keeps every product within the range of single precision.
    image.stretch = (at.slope * image.m) * (at.m * at.spread) * at.m;
    image.sink = at.slope * at.inv_qw * image.m;
    image.lens << row_u_.x() - u * row_z_.x(), row_u_.y() - u * row_z_.y(),  //
        row_v_.x() - v * row_z_.x(), row_v_.y() - v * row_z_.y();
    image.projection.pixel = {u + cx_, v + cy_};
    image.projection.visible = in_field && in_front && image_.contains(image.projection.pixel);
    return image;
  }

 private:
  FlatPortOptics<T> optics_;
  FlatPortField<T> field_;
  // The x, y and z axes of the camera frame in the axis frame. The x axis is multiplied by fx, the
  // y axis by fy.
  Vector3<T> row_u_, row_v_, row_z_;
  T cx_, cy_;
  WidenedImage<T> image_;
};

}  // namespace axial::refractive
