// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/areas.h"

#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "base/error.h"
#include "private/gdal_calls.h"
#include "private/ogr_handles.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

bool has_polygons(OGRLayerH layer) {
  const OGRwkbGeometryType type = wkbFlatten(OGR_L_GetGeomType(layer));
  return type == wkbPolygon || type == wkbMultiPolygon || type == wkbUnknown;
}

OGRLayerH layer_of(GDALDatasetH data, const fs::path& file) {
  std::vector<OGRLayerH> found;
  std::string names;
  for (int i = 0; i < GDALDatasetGetLayerCount(data); ++i) {
    const OGRLayerH layer = GDALDatasetGetLayer(data, i);
    if (!has_polygons(layer)) continue;
    found.push_back(layer);
    names += (names.empty() ? "" : ", ") + std::string(OGR_L_GetName(layer));
  }
  if (found.empty()) fail_in(file, "has no layer with polygons");
  if (found.size() > 1)
    fail_in(file, "has several layers with polygons ({}): write one of them to a file of its own",
            names);
  return found.front();
}

// x is east and y is north in both systems.
Conversion conversion_to(const std::string& crs, OGRLayerH layer, const fs::path& file) {
  const OGRSpatialReferenceH stated = OGR_L_GetSpatialRef(layer);
  if (crs.empty() || stated == nullptr) return {};
  const System from(OSRClone(stated)), to(OSRNewSpatialReference(crs.c_str()));
  for (const auto* system : {&from, &to})
    OSRSetAxisMappingStrategy(system->get(), OAMS_TRADITIONAL_GIS_ORDER);
  if (OSRIsSame(from.get(), to.get())) return {};
  Conversion conversion(OCTNewCoordinateTransformation(from.get(), to.get()));
  if (!conversion)
    fail_in(file, "its coordinate reference system cannot be converted to that of the map");
  return conversion;
}

// The index of the field that names a feature; -1: none.
int name_field(OGRLayerH layer) {
  const OGRFeatureDefnH fields = OGR_L_GetLayerDefn(layer);
  for (const char* wanted : {"name", "label", "id"})
    if (const int index = OGR_FD_GetFieldIndex(fields, wanted); index >= 0) return index;
  return -1;
}

// Adds the rings of a polygon, or of all parts of several.
void add_rings(OGRGeometryH geometry, std::vector<geometry::Ring>& rings) {
  const int parts = OGR_G_GetGeometryCount(geometry);
  if (wkbFlatten(OGR_G_GetGeometryType(geometry)) == wkbMultiPolygon) {
    for (int i = 0; i < parts; ++i) add_rings(OGR_G_GetGeometryRef(geometry, i), rings);
    return;
  }
  for (int i = 0; i < parts; ++i) {
    const OGRGeometryH line = OGR_G_GetGeometryRef(geometry, i);
    geometry::Ring ring;
    for (int k = 0; k < OGR_G_GetPointCount(line); ++k) {
      const Eigen::Vector2d corner(OGR_G_GetX(line, k), OGR_G_GetY(line, k));
      if (ring.empty() || corner != ring.back()) ring.push_back(corner);
    }
    if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    rings.push_back(std::move(ring));
  }
}

void check_rings(const Area& area, const fs::path& file) {
  if (area.rings.empty()) fail_in(file, "polygon '{}' is empty", area.name);
  for (const geometry::Ring& ring : area.rings) {
    if (ring.size() < 3)
      fail_in(file, "polygon '{}' has a ring with fewer than three corners", area.name);
    for (const Eigen::Vector2d& corner : ring)
      if (!corner.allFinite())
        fail_in(file, "polygon '{}' has a coordinate that is not finite", area.name);
  }
  const auto crossings = geometry::crossings_of(area.rings);
  if (crossings.empty()) return;
  const Eigen::Vector2d& at = crossings.front().place;
  fail_in(file, "polygon '{}' crosses itself at ({:.3f}, {:.3f})", area.name, at.x(), at.y());
}

std::string name_of(OGRFeatureH feature, int field, std::size_t number) {
  const std::string name = field < 0 ? "" : OGR_F_GetFieldAsString(feature, field);
  return name.empty() ? std::to_string(number) : name;
}

Area area_of(OGRFeatureH feature, std::string name, OGRCoordinateTransformationH conversion,
             const fs::path& file) {
  Area area{std::move(name), {}};
  const OGRGeometryH stored = OGR_F_GetGeometryRef(feature);
  const OGRwkbGeometryType type =
      stored == nullptr ? wkbNone : wkbFlatten(OGR_G_GetGeometryType(stored));
  if (type != wkbPolygon && type != wkbMultiPolygon)
    fail_in(file, "feature '{}' is no polygon, but {}", area.name,
            type == wkbNone ? "has no geometry" : OGRGeometryTypeToName(type));
  const Geometry geometry(OGR_G_Clone(stored));
  if (conversion != nullptr && OGR_G_Transform(geometry.get(), conversion) != OGRERR_NONE)
    fail_in(file, "polygon '{}' cannot be converted to the coordinates of the map", area.name);
  add_rings(geometry.get(), area.rings);
  check_rings(area, file);
  return area;
}

}  // namespace

std::vector<Area> read_areas(const fs::path& file, const std::string& crs) {
  const GdalErrors errors;
  const DatasetPtr data(
      GDALOpenEx(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  errors.require_vectors_read(data != nullptr, file);
  const OGRLayerH layer = layer_of(data.get(), file);
  const Conversion conversion = conversion_to(crs, layer, file);
  const int field = name_field(layer);
  std::vector<Area> areas;
  OGR_L_ResetReading(layer);
  while (const Feature feature{OGR_L_GetNextFeature(layer)})
    areas.push_back(area_of(feature.get(), name_of(feature.get(), field, areas.size() + 1),
                            conversion.get(), file));
  errors.require_vectors_read(true, file);
  if (areas.empty()) fail_in(file, "has no polygon");
  return areas;
}

}  // namespace axial::map
