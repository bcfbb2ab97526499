// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/areas.h"

#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "private/gdal_calls.h"
#include "private/ogr_handles.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

bool has_polygons(OGRLayerH layer) {
  const OGRwkbGeometryType type = OGR_GT_GetLinear(wkbFlatten(OGR_L_GetGeomType(layer)));
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

geometry::Ring ring_of(OGRGeometryH line) {
  geometry::Ring ring;
  for (int k = 0; k < OGR_G_GetPointCount(line); ++k) {
    const Eigen::Vector2d corner(OGR_G_GetX(line, k), OGR_G_GetY(line, k));
    if (ring.empty() || corner != ring.back()) ring.push_back(corner);
  }
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return ring;
}

// Adds a polygon, or all parts of several.
void add_parts(OGRGeometryH geometry, Area& area) {
  const int count = OGR_G_GetGeometryCount(geometry);
  if (wkbFlatten(OGR_G_GetGeometryType(geometry)) == wkbMultiPolygon) {
    for (int i = 0; i < count; ++i) add_parts(OGR_G_GetGeometryRef(geometry, i), area);
    return;
  }
  std::vector<geometry::Ring> part;
  for (int i = 0; i < count; ++i) part.push_back(ring_of(OGR_G_GetGeometryRef(geometry, i)));
  if (!part.empty()) area.parts.push_back(std::move(part));
}

void check_rings(const Area& area, const fs::path& file) {
  if (area.parts.empty()) fail_in(file, "polygon '{}' is empty", area.name);
  for (const auto& part : area.parts)
    for (const geometry::Ring& ring : part) {
      if (ring.size() < 3)
        fail_in(file, "polygon '{}' has a ring with fewer than three corners", area.name);
      for (const Eigen::Vector2d& corner : ring)
        if (!corner.allFinite())
          fail_in(file, "polygon '{}' has a coordinate that is not finite", area.name);
    }
}

// A place on the ring that is no corner.
Eigen::Vector2d place_on(const geometry::Ring& ring) {
  return (ring[0] + ring[1]) / 2;
}

void check_places(const Area& area, const fs::path& file) {
  std::vector<geometry::Ring> all;
  for (const auto& part : area.parts) all.insert(all.end(), part.begin(), part.end());
  try {
    if (const auto place = geometry::crossing_of(all))
      fail("crosses itself at ({:.3f}, {:.3f})", place->x(), place->y());
    for (const auto& part : area.parts) {
      const geometry::PolygonPieces pieces(part);
      for (const auto& other : area.parts)
        if (&other != &part && pieces.contains(place_on(other.front())))
          fail("has a part in another part");
    }
  } catch (const Error& error) {
    fail_in(file, "polygon '{}' {}", area.name, error.what());
  }
}

std::string name_of(OGRFeatureH feature, std::size_t number) {
  for (const char* field : {"name", "label", "id"}) {
    const int index = OGR_F_GetFieldIndex(feature, field);
    const std::string name = index < 0 ? "" : OGR_F_GetFieldAsString(feature, index);
    if (!name.empty()) return name;
  }
  return std::to_string(number);
}

Area area_of(OGRFeatureH feature, std::string name, OGRCoordinateTransformationH conversion,
             const fs::path& file) {
  Area area{std::move(name), {}};
  const OGRGeometryH stored = OGR_F_GetGeometryRef(feature);
  if (stored == nullptr) fail_in(file, "feature '{}' has no geometry", area.name);
  const OGRwkbGeometryType type = OGR_GT_GetLinear(wkbFlatten(OGR_G_GetGeometryType(stored)));
  if (type != wkbPolygon && type != wkbMultiPolygon)
    fail_in(file, "feature '{}' is no polygon, but {}", area.name, OGRGeometryTypeToName(type));
  const Geometry geometry(OGR_G_GetLinearGeometry(stored, 0, nullptr));
  if (conversion != nullptr && OGR_G_Transform(geometry.get(), conversion) != OGRERR_NONE)
    fail_in(file,
            "polygon '{}' cannot be converted to the coordinates of the map: are its coordinates "
            "in another system than the file states? A GeoJSON file without \"crs\" has degrees of "
            "WGS 84",
            area.name);
  add_parts(geometry.get(), area);
  check_rings(area, file);
  check_places(area, file);
  return area;
}

}  // namespace

std::vector<Area> read_areas(const fs::path& file, const std::string& crs) {
  const GdalErrors errors;
  const DatasetPtr data = open_vectors(file, errors);
  const OGRLayerH layer = layer_of(data.get(), file);
  const Conversion conversion = conversion_to(crs, layer, file);
  std::vector<Area> areas;
  OGR_L_ResetReading(layer);
  while (const Feature feature{OGR_L_GetNextFeature(layer)})
    areas.push_back(
        area_of(feature.get(), name_of(feature.get(), areas.size() + 1), conversion.get(), file));
  errors.require_vectors_read(true, file);
  if (areas.empty()) fail_in(file, "has no polygon");
  return areas;
}

}  // namespace axial::map
