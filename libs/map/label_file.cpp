// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/label_file.h"

#include <ogr_srs_api.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "private/vector_file.h"
#include "private/vector_output.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

std::vector<Eigen::Vector2d> points_of(const FoundFeature& found, const fs::path& file) {
  std::vector<Eigen::Vector2d> points;
  const bool is_one = plain_type(found.shape) == wkbPoint;
  const int count = is_one ? 1 : OGR_G_GetGeometryCount(found.shape);
  for (int i = 0; i < count; ++i) {
    const OGRGeometryH point = is_one ? found.shape : OGR_G_GetGeometryRef(found.shape, i);
    if (OGR_G_IsEmpty(point)) fail_in(file, "point '{}' is empty", found.name);
    points.emplace_back(OGR_G_GetX(point, 0), OGR_G_GetY(point, 0));
    if (!points.back().allFinite())
      fail_in(file, "point '{}' has a coordinate that is not finite", found.name);
  }
  if (points.empty()) fail_in(file, "point '{}' is empty", found.name);
  return points;
}

std::string category_of(OGRFeatureH feature, const std::string& field) {
  std::string value = field.empty()
                          ? first_value(feature, {"class", "category", "species", "label"})
                          : first_value(feature, {field.c_str()});
  return value.empty() ? "label" : value;
}

// Adds features with the fields of a label to a layer.
class LabelLayer {
 public:
  explicit LabelLayer(OGRLayerH layer) : layer_(layer) {
    for (const char* name : {"name", "class", "photograph"})
      works_ = works_ && add_field(layer, name, OFTString);
  }

  bool works() const { return works_; }

  void add(const LabelFromPhotograph& one, OGRGeometryH shape) {
    const Feature feature(OGR_F_Create(OGR_L_GetLayerDefn(layer_)));
    const std::string* const values[] = {&one.label.name, &one.label.category, &one.photograph};
    for (int i = 0; i < 3; ++i) OGR_F_SetFieldString(feature.get(), i, values[i]->c_str());
    OGR_F_SetGeometry(feature.get(), shape);
    works_ = works_ && OGR_L_CreateFeature(layer_, feature.get()) == OGRERR_NONE;
  }

 private:
  OGRLayerH layer_;
  bool works_ = true;
};

// The heights of the corners of all rings. A corner without a surface has the height of the nearest
// corner with one.
std::vector<double> corner_heights(const LabelFromPhotograph& one) {
  std::vector<Eigen::Vector2d> corners;
  for (const auto& rings : one.label.parts)
    for (const geometry::Ring& ring : rings)
      corners.insert(corners.end(), ring.begin(), ring.end());
  std::vector<double> heights(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    heights[i] = one.heights[i];
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < corners.size() && !std::isfinite(one.heights[i]); ++k) {
      const double distance = (corners[k] - corners[i]).squaredNorm();
      if (!std::isfinite(one.heights[k]) || distance >= least) continue;
      least = distance;
      heights[i] = one.heights[k];
    }
  }
  return heights;
}

Geometry polygons_of(const LabelFromPhotograph& one) {
  Geometry parts(OGR_G_CreateGeometry(wkbMultiPolygon25D));
  const std::vector<double> heights = corner_heights(one);
  auto height = heights.begin();
  for (const auto& rings : one.label.parts) {
    const OGRGeometryH polygon = OGR_G_CreateGeometry(wkbPolygon25D);
    for (const geometry::Ring& ring : rings) {
      const OGRGeometryH line = OGR_G_CreateGeometry(wkbLinearRing);
      for (const Eigen::Vector2d& corner : ring)
        OGR_G_AddPoint(line, corner.x(), corner.y(), *height++);
      OGR_G_CloseRings(line);
      OGR_G_AddGeometryDirectly(polygon, line);
    }
    OGR_G_AddGeometryDirectly(parts.get(), polygon);
  }
  return parts;
}

Geometry points_of(const LabelFromPhotograph& one) {
  Geometry points(OGR_G_CreateGeometry(wkbMultiPoint25D));
  const auto& places = one.label.points;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const OGRGeometryH point = OGR_G_CreateGeometry(wkbPoint25D);
    OGR_G_AddPoint(point, places[i].x(), places[i].y(),
                   one.heights[one.heights.size() - places.size() + i]);
    OGR_G_AddGeometryDirectly(points.get(), point);
  }
  return points;
}

bool has_parts(const LabelFromPhotograph& one) {
  return !one.label.parts.empty();
}

bool has_points(const LabelFromPhotograph& one) {
  return !one.label.points.empty();
}

void write_geojson(const fs::path& file, std::span<const LabelFromPhotograph> labels,
                   const std::string& crs) {
  const GdalErrors errors;
  DatasetPtr data = make_vector_file("GeoJSON", file, errors);
  const System system(crs.empty() ? nullptr : OSRNewSpatialReference(crs.c_str()));
  const GdalOptions options{{"COORDINATE_PRECISION", "4"}, {"WRITE_NAME", "NO"}};
  const OGRLayerH layer =
      GDALDatasetCreateLayer(data.get(), "labels", system.get(), wkbUnknown, options.list());
  errors.require_written(layer != nullptr, file);
  LabelLayer both(layer);
  for (const LabelFromPhotograph& one : labels) {
    if (has_parts(one)) both.add(one, polygons_of(one).get());
    if (has_points(one)) both.add(one, points_of(one).get());
  }
  data.reset();
  errors.require_written(both.works(), file);
  require_complete_geojson(file);
}

void write_package(const fs::path& file, std::span<const LabelFromPhotograph> labels,
                   const std::string& crs) {
  const GdalErrors errors;
  const FixedDate date;
  DatasetPtr data = make_vector_file("GPKG", file, errors);
  const System system(crs.empty() ? nullptr : OSRNewSpatialReference(crs.c_str()));
  bool works = true;
  const auto write_layer = [&](const char* name, OGRwkbGeometryType type, auto has_shape,
                               auto shape_of) {
    if (std::ranges::none_of(labels, has_shape)) return;
    const OGRLayerH made = GDALDatasetCreateLayer(data.get(), name, system.get(), type, nullptr);
    errors.require_written(made != nullptr, file);
    LabelLayer layer(made);
    for (const LabelFromPhotograph& one : labels)
      if (has_shape(one)) layer.add(one, shape_of(one).get());
    works = works && layer.works();
  };
  write_layer("polygons", wkbMultiPolygon25D, has_parts, polygons_of);
  write_layer("points", wkbMultiPoint25D, has_points,
              [](const LabelFromPhotograph& one) { return points_of(one); });
  data.reset();
  errors.require_written(works, file);
}

}  // namespace

std::vector<Label> read_labels(const fs::path& file, const std::string& crs,
                               const std::string& field) {
  std::vector<Label> labels;
  bool has_field = field.empty();
  for_each_feature(file, crs, Shapes::polygons_and_points, [&](const FoundFeature& found) {
    has_field = has_field || OGR_F_GetFieldIndex(found.feature, field.c_str()) >= 0;
    Label label{found.name, category_of(found.feature, field), {}, {}};
    const OGRwkbGeometryType type = plain_type(found.shape);
    if (type == wkbPoint || type == wkbMultiPoint)
      label.points = points_of(found, file);
    else
      label.parts = area_of(found, file).parts;
    labels.push_back(std::move(label));
  });
  if (!has_field) fail_in(file, "has no field '{}'", field);
  return labels;
}

void write_labels(const LabelFiles& files, std::span<const LabelFromPhotograph> labels,
                  const std::string& crs) {
  write_together({files.geojson, files.package}, [&](const std::vector<fs::path>& temporaries) {
    write_geojson(temporaries[0], labels, crs);
    write_package(temporaries[1], labels, crs);
  });
}

}  // namespace axial::map
