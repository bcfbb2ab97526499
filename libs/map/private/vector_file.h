// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/map: the features of files of GIS programs, in the coordinates of a map.
#pragma once

#include <ogr_api.h>

#include <filesystem>
#include <functional>
#include <string>

#include "map/areas.h"

namespace axial::map {

enum class Shapes { polygons, lines, polygons_and_points };

// A feature of a file. `shape` has the coordinates of the map, and no curves.
struct FoundFeature {
  OGRFeatureH feature;
  OGRGeometryH shape;
  std::string name;  // as read_areas() names areas
};

// Calls use(found) for each feature of a GeoJSON, GeoPackage or shape file, layer by layer in their
// order. Layers of other shapes are left out. Coordinates are converted as by read_areas(). Error
// that names the file, and the feature: the file cannot be read; it has no layer with such shapes,
// or several layers unless for Shapes::polygons_and_points; these layers have no feature; a feature
// has another shape, or coordinates that cannot be converted.
void for_each_feature(const std::filesystem::path& file, const std::string& crs, Shapes shapes,
                      const std::function<void(const FoundFeature& found)>& use);

// The type of a shape without curves, heights and measures.
OGRwkbGeometryType plain_type(OGRGeometryH shape);

// The polygon of a feature. Errors of read_areas() about rings, with `file`.
Area area_of(const FoundFeature& found, const std::filesystem::path& file);

// The value of the first of `fields` (in any case) that the feature has and that is not empty;
// empty if there is none.
std::string first_value(OGRFeatureH feature, std::initializer_list<const char*> fields);

}  // namespace axial::map
