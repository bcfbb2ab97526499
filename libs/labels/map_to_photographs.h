// SPDX-License-Identifier: GPL-3.0-or-later
// Labels on a map in the photographs that see them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/polygon_pieces.h"
#include "labels/labelled_surface.h"
#include "labels/posed_rays.h"
#include "map/label_file.h"

namespace axial::labels {

// A label in a photograph.
struct SeenLabel {
  std::size_t index = 0;  // of the label on the map
  map::Label label;       // [px], with at least one part or point
};

// Labels on a map. All functions may be called concurrently.
class MapLabels {
 public:
  // `labels`: [map]. `surface` must outlive the object. Error of geometry::PolygonPieces that
  // names the first label with an error.
  MapLabels(const LabelledSurface& surface, std::span<const map::Label> labels);

  // The labels that a photograph shows, in their order.
  //
  // A pixel belongs to a polygon if its ray first meets the surface at a place above or below the
  // polygon. So parts are cut off that other parts of the mesh hide or that are outside the
  // photograph, and sides below an overhang belong to the polygon around them. The outline is that
  // of geometry::region_outlines() with the pixels as samples: it is off by some hundredths of a
  // pixel where it is smooth, and cuts right angles by up to 0.36 px. A point lies on the highest
  // surface. It is seen if no face hides it (LabelledSurface::pixel_of()).
  std::vector<SeenLabel> seen_in(const PosedRays& rays) const;

  // False if the label lies beside the surface.
  bool is_on_surface(std::size_t label) const;

 private:
  // Faces in a ball [frame of the mesh].
  struct Chunk {
    std::vector<std::uint32_t> faces;
    Eigen::Vector3d centre;
    double radius = 0;
  };
  // A polygon with the faces that may lie above or below it; or points.
  struct Placed {
    std::vector<geometry::PolygonPieces> polygon;  // one, or none
    std::vector<Chunk> chunks;
    std::vector<Eigen::Vector3d> points;  // on the surface [map]
  };
  class Pixels;

  void make_blocks();
  Placed placed(const map::Label& label) const;
  Chunk chunk_in(std::size_t block, const Eigen::AlignedBox2d& around) const;
  std::vector<std::vector<geometry::Ring>> parts_in(const PosedRays& rays, const Placed& placed,
                                                    Pixels& pixels) const;

  const LabelledSurface& surface_;
  std::span<const map::Label> labels_;
  std::vector<Eigen::AlignedBox2d> blocks_;  // around 256 consecutive faces each [map]
  std::vector<Placed> placed_;
};

}  // namespace axial::labels
