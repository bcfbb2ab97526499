// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels/map_to_photographs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/first_error.h"
#include "base/parallel.h"
#include "geometry/faces.h"
#include "geometry/region_outlines.h"
#include "labels/view_cone.h"

namespace axial::labels {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

constexpr std::size_t kBlock = 256;

std::vector<geometry::Ring> rings_from(const map::Label& label, const Eigen::Vector2d& origin) {
  std::vector<geometry::Ring> rings;
  for (const auto& part : label.parts)
    for (geometry::Ring ring : part) {
      for (Eigen::Vector2d& corner : ring) corner -= origin;
      rings.push_back(std::move(ring));
    }
  return rings;
}

}  // namespace

// The pixels of a photograph that may show faces.
class MapLabels::Pixels {
 public:
  explicit Pixels(const PosedRays& rays) : rays_(rays), cone_(rays) {}

  const ViewCone& cone() const { return cone_; }

  void clear() { box_.setEmpty(); }

  // Adds the pixels that may show the face. A face that is large, as seen from the camera, is
  // divided: refraction bends its edges, and some of it may be outside the field of the camera.
  void add(const Triangle& face, int levels = 8) {
    constexpr double kLarge = 0.1;  // of the distance
    const Eigen::Vector3d centre = (face[0] + face[1] + face[2]) / 3;
    double radius = 0;
    for (const Eigen::Vector3d& corner : face) radius = std::max(radius, (corner - centre).norm());
    if (!cone_.may_meet(centre, radius)) return;
    if (levels > 0 && radius > kLarge * ((centre - cone_.apex()).norm() - radius)) {
      const Eigen::Vector3d a = (face[1] + face[2]) / 2, b = (face[2] + face[0]) / 2,
                            c = (face[0] + face[1]) / 2;
      for (const Triangle& part : {Triangle{face[0], c, b}, Triangle{face[1], a, c},
                                   Triangle{face[2], b, a}, Triangle{a, b, c}})
        add(part, levels - 1);
      return;
    }
    for (const Eigen::Vector3d& corner : face)
      if (const auto pixel = rays_.pixel_of(corner)) box_.extend(*pixel);
  }

  // The pixels of the photograph, and of a rim of one pixel around it.
  geometry::SampleGrid grid() const {
    constexpr double kAround = 2;
    const auto& camera = rays_.posed().camera;
    if (box_.isEmpty()) return {};
    const auto within = [](double value, int size) {
      return static_cast<int>(std::clamp<double>(std::round(value), -1, size));
    };
    const int left = within(box_.min().x() - kAround, camera.width),
              top = within(box_.min().y() - kAround, camera.height);
    return {Eigen::Vector2d(left, top), 1,
            within(box_.max().x() + kAround, camera.width) + 1 - left,
            within(box_.max().y() + kAround, camera.height) + 1 - top};
  }

 private:
  const PosedRays& rays_;
  ViewCone cone_;
  Eigen::AlignedBox2d box_;
};

MapLabels::MapLabels(const LabelledSurface& surface, std::span<const map::Label> labels)
    : surface_(surface), labels_(labels), placed_(labels.size()) {
  make_blocks();
  FirstError error;
  parallel_for(labels.size(), [&](std::size_t i) {
    error.run(i, [&] {
      try {
        placed_[i] = placed(labels[i]);
      } catch (const Error& reason) {
        fail("polygon '{}' {}", labels[i].name, reason.text());
      }
    });
  });
  error.rethrow();
}

// Faces that follow each other in a mesh mostly lie near each other.
void MapLabels::make_blocks() {
  const std::size_t faces = surface_.mesh().faces.size();
  blocks_.resize((faces + kBlock - 1) / kBlock);
  parallel_for(blocks_.size(), [&](std::size_t block) {
    for (std::size_t face = block * kBlock; face < std::min(faces, (block + 1) * kBlock); ++face)
      for (const Eigen::Vector3d& corner : geometry::corners_of(surface_.mesh(), face))
        blocks_[block].extend(surface_.to_map(corner).head<2>());
  });
}

MapLabels::Placed MapLabels::placed(const map::Label& label) const {
  Placed placed;
  const Eigen::Vector2d origin = surface_.origin().head<2>();
  for (const Eigen::Vector2d& point : label.points)
    if (const auto place = surface_.highest(point - origin)) placed.points.push_back(*place);
  if (label.parts.empty()) return placed;
  const std::vector<geometry::Ring> rings = rings_from(label, origin);
  placed.polygon.emplace_back(rings);
  Eigen::AlignedBox2d around;
  for (const geometry::Ring& ring : rings)
    for (const Eigen::Vector2d& corner : ring) around.extend(corner);
  for (std::size_t block = 0; block < blocks_.size(); ++block)
    if (blocks_[block].intersects(around))
      if (Chunk chunk = chunk_in(block, around); !chunk.faces.empty())
        placed.chunks.push_back(std::move(chunk));
  return placed;
}

MapLabels::Chunk MapLabels::chunk_in(std::size_t block, const Eigen::AlignedBox2d& around) const {
  const Mesh& mesh = surface_.mesh();
  Chunk chunk;
  Eigen::AlignedBox3d space;
  for (std::size_t face = block * kBlock; face < std::min(mesh.faces.size(), (block + 1) * kBlock);
       ++face) {
    if (!mesh.unseen.empty() && mesh.unseen[face] != 0) continue;
    const Triangle corners = geometry::corners_of(mesh, face);
    Eigen::AlignedBox2d on_map;
    for (const Eigen::Vector3d& corner : corners) on_map.extend(surface_.to_map(corner).head<2>());
    if (!on_map.intersects(around)) continue;
    chunk.faces.push_back(static_cast<std::uint32_t>(face));
    for (const Eigen::Vector3d& corner : corners) space.extend(corner);
  }
  chunk.centre = space.center();
  chunk.radius = space.diagonal().norm() / 2;
  return chunk;
}

std::vector<SeenLabel> MapLabels::seen_in(const PosedRays& rays) const {
  Pixels pixels(rays);
  std::vector<SeenLabel> seen;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    const Placed& placed = placed_[i];
    SeenLabel found{i, {labels_[i].name, labels_[i].category, {}, {}}};
    if (!placed.chunks.empty()) found.label.parts = parts_in(rays, placed, pixels);
    for (const Eigen::Vector3d& point : placed.points)
      if (const auto pixel = surface_.pixel_of(rays, point)) found.label.points.push_back(*pixel);
    if (!found.label.parts.empty() || !found.label.points.empty()) seen.push_back(std::move(found));
  }
  return seen;
}

std::vector<std::vector<geometry::Ring>> MapLabels::parts_in(const PosedRays& rays,
                                                             const Placed& placed,
                                                             Pixels& pixels) const {
  pixels.clear();
  for (const Chunk& chunk : placed.chunks)
    if (pixels.cone().may_meet(chunk.centre, chunk.radius))
      for (const std::uint32_t face : chunk.faces)
        pixels.add(geometry::corners_of(surface_.mesh(), face));
  return geometry::region_outlines(pixels.grid(), [&](const Eigen::Vector2d& pixel) {
    if (!rays.is_in_photograph(pixel)) return false;
    const auto sight = rays.sight(pixel);
    const auto place = sight ? surface_.seen_by(*sight) : std::nullopt;
    return place && placed.polygon.front().contains(place->head<2>());
  });
}

bool MapLabels::is_on_surface(std::size_t label) const {
  return !placed_[label].chunks.empty() || !placed_[label].points.empty();
}

}  // namespace axial::labels
