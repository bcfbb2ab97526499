// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/vector_file.h"

#include <ogr_srs_api.h>

#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "private/gdal_calls.h"
#include "private/ogr_handles.h"
#include "private/polygon_shapes.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

bool is_polygon(OGRwkbGeometryType type) {
  return type == wkbPolygon || type == wkbMultiPolygon;
}

bool is_point(OGRwkbGeometryType type) {
  return type == wkbPoint || type == wkbMultiPoint;
}

bool is_line(OGRwkbGeometryType type) {
  return type == wkbLineString || type == wkbMultiLineString;
}

// What the shapes are called in messages.
struct Words {
  const char *several, *none;
};

Words words_of(Shapes shapes) {
  if (shapes == Shapes::polygons) return {"polygons", "no polygon"};
  if (shapes == Shapes::lines) return {"lines", "no line"};
  return {"polygons or points", "neither polygon nor point"};
}

bool is_one_of(OGRwkbGeometryType type, Shapes shapes) {
  if (shapes == Shapes::lines) return is_line(type);
  return is_polygon(type) || (shapes == Shapes::polygons_and_points && is_point(type));
}

bool may_have(OGRLayerH layer, Shapes shapes) {
  const OGRwkbGeometryType type = OGR_GT_GetLinear(wkbFlatten(OGR_L_GetGeomType(layer)));
  return type == wkbUnknown || is_one_of(type, shapes);
}

// The layers that may have such shapes. Of shapes that are measured, only one.
std::vector<OGRLayerH> layers_of(GDALDatasetH data, Shapes shapes, const fs::path& file) {
  std::vector<OGRLayerH> found;
  std::string names;
  for (int i = 0; i < GDALDatasetGetLayerCount(data); ++i) {
    const OGRLayerH layer = GDALDatasetGetLayer(data, i);
    if (!may_have(layer, shapes)) continue;
    found.push_back(layer);
    names += (names.empty() ? "" : ", ") + std::string(OGR_L_GetName(layer));
  }
  const char* const several = words_of(shapes).several;
  if (found.empty()) fail_in(file, "has no layer with {}", several);
  if (found.size() > 1 && shapes != Shapes::polygons_and_points)
    fail_in(file, "has several layers with {} ({}): write one of them to a file of its own",
            several, names);
  return found;
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
  const std::string name = first_value(feature, {"name", "label", "id"});
  return name.empty() ? std::to_string(number) : name;
}

// The shape of a feature in the coordinates of the map, without curves.
Geometry shape_of(OGRFeatureH feature, const std::string& name, Shapes shapes,
                  OGRCoordinateTransformationH conversion, const fs::path& file) {
  const OGRGeometryH stored = OGR_F_GetGeometryRef(feature);
  if (stored == nullptr) fail_in(file, "feature '{}' has no geometry", name);
  const OGRwkbGeometryType type = plain_type(stored);
  if (!is_one_of(type, shapes))
    fail_in(file, "feature '{}' is {}, but {}", name, words_of(shapes).none,
            OGRGeometryTypeToName(type));
  Geometry shape(OGR_G_GetLinearGeometry(stored, 0, nullptr));
  if (conversion != nullptr && OGR_G_Transform(shape.get(), conversion) != OGRERR_NONE)
    fail_in(file,
            "{} '{}' cannot be converted to the coordinates of the map: are its coordinates "
            "in another system than the file states? A GeoJSON file without \"crs\" has degrees of "
            "WGS 84",
            is_point(type)  ? "point"
            : is_line(type) ? "line"
                            : "polygon",
            name);
  return shape;
}

}  // namespace

OGRwkbGeometryType plain_type(OGRGeometryH shape) {
  return OGR_GT_GetLinear(wkbFlatten(OGR_G_GetGeometryType(shape)));
}

std::string first_value(OGRFeatureH feature, std::initializer_list<const char*> fields) {
  for (const char* field : fields) {
    const int index = OGR_F_GetFieldIndex(feature, field);
    std::string value = index < 0 ? "" : OGR_F_GetFieldAsString(feature, index);
    if (!value.empty()) return value;
  }
  return {};
}

Area area_of(const FoundFeature& found, const fs::path& file) {
  Area area{found.name, {}};
  add_parts(found.shape, area.parts);
  check_rings(area, file);
  check_places(area, file);
  return area;
}

void for_each_feature(const fs::path& file, const std::string& crs, Shapes shapes,
                      const std::function<void(const FoundFeature& found)>& use) {
  const GdalErrors errors;
  const DatasetPtr data = open_vectors(file, errors);
  std::size_t count = 0;
  for (const OGRLayerH layer : layers_of(data.get(), shapes, file)) {
    const Conversion conversion = conversion_to(crs, layer, file);
    OGR_L_ResetReading(layer);
    while (const Feature feature{OGR_L_GetNextFeature(layer)}) {
      const std::string name = name_of(feature.get(), ++count);
      const Geometry shape = shape_of(feature.get(), name, shapes, conversion.get(), file);
      use({feature.get(), shape.get(), name});
    }
  }
  errors.require_vectors_read(true, file);
  if (count == 0) fail_in(file, "has {}", words_of(shapes).none);
}

std::vector<Area> read_areas(const fs::path& file, const std::string& crs) {
  std::vector<Area> areas;
  for_each_feature(file, crs, Shapes::polygons,
                   [&](const FoundFeature& found) { areas.push_back(area_of(found, file)); });
  return areas;
}

}  // namespace axial::map
