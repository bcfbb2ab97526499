// SPDX-License-Identifier: GPL-3.0-or-later
// Labels: polygons and points with classes, on a map or in a photograph, and their files of GIS
// programs.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "map/areas.h"

namespace axial::map {

// What was labelled: a polygon, or points.
struct Label {
  std::string name;
  std::string category;  // the class, such as a species
  // Of a polygon: parts beside each other, as Area::parts [map, or px of the photograph].
  std::vector<std::vector<geometry::Ring>> parts;
  std::vector<Eigen::Vector2d> points;  // [map, or px of the photograph]
};

// The polygons and points of all layers of a GeoJSON, GeoPackage or shape file, in their order;
// layers of other shapes are left out. Names, coordinate reference systems and Errors as for
// read_areas(), which has no points and one layer. The class is the value of `field` (in any case),
// or, if `field` is empty, of the first field of class, category, species and label that has a
// value; otherwise "label". Error that names the file and the field if no feature has the field
// `field`.
std::vector<Label> read_labels(const std::filesystem::path& file, const std::string& crs,
                               const std::string& field);

// A label that was drawn in a photograph, on the map.
struct LabelFromPhotograph {
  std::string photograph;  // its name
  Label label;             // [map]
  // Of the surface at the places of the label [map, m]: first at the corners of all rings, then at
  // the points. NaN at a corner: no surface there; at least one corner and all points have heights.
  std::vector<double> heights;
};

struct LabelFiles {
  std::filesystem::path geojson, package;
};

// Writes a feature with heights for each label that has a part or a point: a GeoJSON with
// MultiPolygons and MultiPoints, and a GeoPackage with the layers "polygons" and "points". A layer
// without features is left out. A corner without a height gets that of the nearest corner with one.
// Their fields are "name", "class" and "photograph". Coordinates of the GeoJSON have four digits.
// `crs`: WKT of the coordinates; empty: none. The same labels give the same bytes. Both files are
// written together (write_together()). Error that names a file that cannot be written.
void write_labels(const LabelFiles& files, std::span<const LabelFromPhotograph> labels,
                  const std::string& crs);

}  // namespace axial::map
