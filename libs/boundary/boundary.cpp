// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary/boundary.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/naming.h"
#include "boundary/target_ring.h"
#include "control/target_places.h"
#include "map/areas.h"
#include "map/map_place.h"

namespace axial::boundary {
namespace {

namespace fs = std::filesystem;

std::vector<Boundary::Polygon> polygons_of(const std::vector<map::Area>& areas) {
  std::vector<Boundary::Polygon> polygons;
  for (const map::Area& area : areas)
    polygons.insert(polygons.end(), area.parts.begin(), area.parts.end());
  return polygons;
}

std::string joined(const std::vector<std::string>& labels) {
  std::string text;
  for (const std::string& label : labels) text += (text.empty() ? "" : ",") + label;
  return text;
}

fs::path file_of_places(const Options& options, const fs::path& mesh) {
  if (!options.places.empty()) return options.places;
  const fs::path file = control::places_beside(mesh, setting("target_places"));
  if (file.empty())
    fail_in(mesh, "no {} in its folder or in refined/ there; {} states the file",
            control::kTargetPlaces, setting("target_places"));
  return file;
}

std::vector<Boundary::Polygon> outline_of_targets(const Options& options, const fs::path& file,
                                                  const map::WorldAxes& axes) {
  geometry::Ring ring;
  for (const Eigen::Vector3d& corner : places_of_targets(file, options.targets))
    ring.emplace_back((axes.axes * corner + axes.offset).head<2>());
  const std::vector<geometry::Ring> rings{ring};
  if (const auto crossing = geometry::crossing_of(rings))
    fail(
        "{} {}: the outline crosses itself at ({:.3f}, {:.3f}): name the targets in their order "
        "around the area",
        setting("boundary_targets"), joined(options.targets), crossing->x(), crossing->y());
  return {rings};
}

}  // namespace

Boundary::Boundary(std::vector<Polygon> polygons, const map::WorldAxes& axes,
                   const LocalFrame& mesh_frame, std::string name)
    : polygons_(std::move(polygons)),
      plan_(axes.axes.topRows<2>()),
      origin_((axes.axes * mesh_frame.origin + axes.offset).head<2>()),
      name_(std::move(name)) {
  for (Polygon& polygon : polygons_) {
    for (geometry::Ring& ring : polygon)
      for (Eigen::Vector2d& corner : ring) corner -= origin_;
    pieces_.emplace_back(polygon);
  }
}

bool Boundary::contains(const Eigen::Vector2d& plan) const {
  return std::ranges::any_of(
      pieces_, [&](const geometry::PolygonPieces& pieces) { return pieces.contains(plan); });
}

Eigen::AlignedBox2d Boundary::extent() const {
  Eigen::AlignedBox2d box;
  for (const Polygon& polygon : polygons_)
    for (const geometry::Ring& ring : polygon)
      for (const Eigen::Vector2d& corner : ring) box.extend(on_map(corner));
  return box;
}

Boundary read_boundary(const Options& options, const map::WorldAxes& axes, const std::string& crs,
                       const LocalFrame& mesh_frame, const fs::path& mesh) {
  if (options.targets.empty())
    return naming(options.file, [&] {
      return Boundary(polygons_of(map::read_areas(options.file, crs)), axes, mesh_frame,
                      options.file.string());
    });
  return Boundary(outline_of_targets(options, file_of_places(options, mesh), axes), axes,
                  mesh_frame, setting("boundary_targets") + " " + joined(options.targets));
}

void check_files(const Options& options, const fs::path& mesh, const std::string& crs) {
  const std::string of_map = options.map.empty() ? crs : map::place_of_map(options.map).crs;
  if (!options.file.empty()) map::read_areas(options.file, of_map);
  if (!options.targets.empty()) places_of_targets(file_of_places(options, mesh), options.targets);
}

std::optional<map::WorldAxes> take_map(const Options& options, std::string& crs) {
  if (options.map.empty()) return {};
  const map::MapPlace place = map::place_of_map(options.map);
  crs = place.crs;
  return place.axes;
}

}  // namespace axial::boundary
