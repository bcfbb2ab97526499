// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh below its map, for rays from photographs and from above.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "geometry/surface.h"
#include "labels/posed_rays.h"
#include "map/world_axes.h"
#include "scene/local_frame.h"
#include "scene/mesh.h"

namespace axial::labels {

// Places of the map are relative to origin(), which lies near the mesh, so that they keep their
// digits. A face that is marked as unseen hides faces, but has no places.
class LabelledSurface {
 public:
  // `mesh` is in the frame `frame`, and must outlive the object. `axes`: of the map in the world.
  // Errors of geometry::Surface.
  LabelledSurface(const Mesh& mesh, const LocalFrame& frame, const map::WorldAxes& axes);

  const Mesh& mesh() const { return mesh_; }
  const Eigen::Vector3d& origin() const { return origin_; }  // [map]

  // Between places in the frame of the mesh and places of the map.
  Eigen::Vector3d to_map(const Eigen::Vector3d& place) const { return axes_ * place + offset_; }
  Eigen::Vector3d from_map(const Eigen::Vector3d& place) const {
    return axes_.transpose() * (place - offset_);
  }

  // The place of the map at which a sight meets the surface; nothing if it meets none.
  std::optional<Eigen::Vector3d> seen_by(const Sight& sight) const;

  // The highest place of the surface at (x, y) of the map: the one that a map shows. Nothing if
  // there is none.
  std::optional<Eigen::Vector3d> highest(const Eigen::Vector2d& at) const;

  // The pixel that sees a place of the map: in the photograph, and with no face in between. Faces
  // in the last thousandth of the way do not hide the place, because it lies on a face.
  std::optional<Eigen::Vector2d> pixel_of(const PosedRays& rays,
                                          const Eigen::Vector3d& place) const;

 private:
  std::optional<Eigen::Vector3d> first_on(const Eigen::Vector3d& from,
                                          const Eigen::Vector3d& direction) const;

  const Mesh& mesh_;
  geometry::Surface surface_;
  Eigen::Vector3d origin_;
  Eigen::Matrix3d axes_;
  Eigen::Vector3d offset_;
  double top_ = 0;  // above all places [map]
};

// The memory [bytes] of a LabelledSurface of `mesh` while it is made.
std::uint64_t bytes_of_labelled_surface(const Mesh& mesh);

}  // namespace axial::labels
