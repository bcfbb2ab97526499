// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/area_table.h"

#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <cmath>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "private/csv.h"
#include "private/vector_output.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

struct Column {
  const char* name;
  double (*value)(const AreaMeasures& found);
  int digits;
  int power = 0;  // of a length, for the standard deviation; 0: without
};

constexpr Column kColumns[] = {
    {"polygon_m2", [](const AreaMeasures& m) { return m.polygon; }, 6, 2},
    {"planar_m2", [](const AreaMeasures& m) { return m.planar; }, 6, 2},
    {"surface_m2", [](const AreaMeasures& m) { return m.surface; }, 6, 2},
    {"rugosity", [](const AreaMeasures& m) { return m.rugosity(); }, 5},
    {"rugosity_on_slope", [](const AreaMeasures& m) { return m.rugosity_on_slope(); }, 5},
    {"slope_degrees", [](const AreaMeasures& m) { return m.slope_degrees(); }, 3},
    {"aspect_degrees", [](const AreaMeasures& m) { return m.aspect_degrees(); }, 2},
    {"lowest_m", [](const AreaMeasures& m) { return m.lowest; }, 4},
    {"mean_height_m", [](const AreaMeasures& m) { return m.plane.level; }, 4},
    {"highest_m", [](const AreaMeasures& m) { return m.highest; }, 4},
    {"relief_m", [](const AreaMeasures& m) { return m.highest - m.lowest; }, 4, 1},
    {"roughness_m", [](const AreaMeasures& m) { return m.roughness(); }, 5, 1},
    {"volume_above_m3", [](const AreaMeasures& m) { return m.above; }, 6, 3},
    {"volume_below_m3", [](const AreaMeasures& m) { return m.below; }, 6, 3},
    {"rim_share", [](const AreaMeasures& m) { return m.rim; }, 3}};

struct Cell {
  std::string name;
  double value;  // NaN: not known
  int digits;
};

// The cells of a row behind its name. Names are the same for all rows.
std::vector<Cell> cells_of(const AreaMeasures& found, double length_sigma) {
  std::vector<Cell> cells;
  for (const Column& column : kColumns) {
    const double value = column.value(found);
    cells.push_back({column.name, value, column.digits});
    if (length_sigma > 0 && column.power > 0)
      cells.push_back({std::string("sigma_") + column.name,
                       std::abs(value) * column.power * length_sigma, column.digits + 1});
  }
  return cells;
}

Geometry geometry_of(const Area& area) {
  Geometry parts(OGR_G_CreateGeometry(wkbMultiPolygon));
  for (const auto& rings : area.parts) {
    const OGRGeometryH polygon = OGR_G_CreateGeometry(wkbPolygon);
    for (const geometry::Ring& ring : rings) {
      const OGRGeometryH line = OGR_G_CreateGeometry(wkbLinearRing);
      for (const Eigen::Vector2d& corner : ring) OGR_G_AddPoint_2D(line, corner.x(), corner.y());
      OGR_G_CloseRings(line);
      OGR_G_AddGeometryDirectly(polygon, line);
    }
    OGR_G_AddGeometryDirectly(parts.get(), polygon);
  }
  return parts;
}

bool add_feature(OGRLayerH layer, const MeasuredArea& one, std::span<const Cell> cells) {
  const Feature feature(OGR_F_Create(OGR_L_GetLayerDefn(layer)));
  OGR_F_SetFieldString(feature.get(), 0, one.area.name.c_str());
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (std::isfinite(cells[i].value))
      OGR_F_SetFieldDouble(feature.get(), static_cast<int>(i) + 1, cells[i].value);
  OGR_F_SetGeometry(feature.get(), geometry_of(one.area).get());
  return OGR_L_CreateFeature(layer, feature.get()) == OGRERR_NONE;
}

void write_package(const fs::path& file, std::span<const MeasuredArea> areas, double length_sigma,
                   const std::string& crs) {
  const GdalErrors errors;
  const FixedDate date;
  DatasetPtr data = make_vector_file("GPKG", file, errors);
  const System system(crs.empty() ? nullptr : OSRNewSpatialReference(crs.c_str()));
  const OGRLayerH layer =
      GDALDatasetCreateLayer(data.get(), "areas", system.get(), wkbMultiPolygon, nullptr);
  errors.require_written(layer != nullptr, file);
  bool works = add_field(layer, "name", OFTString);
  if (!areas.empty())
    for (const Cell& cell : cells_of(areas.front().measures, length_sigma))
      works = works && add_field(layer, cell.name.c_str(), OFTReal);
  for (const MeasuredArea& one : areas)
    works = works && add_feature(layer, one, cells_of(one.measures, length_sigma));
  data.reset();
  errors.require_written(works, file);
}

std::string csv_of(std::span<const MeasuredArea> areas, double length_sigma) {
  std::string text;
  for (const MeasuredArea& one : areas) {
    const std::vector<Cell> cells = cells_of(one.measures, length_sigma);
    if (text.empty()) {
      text = "name";
      for (const Cell& cell : cells) text += "," + cell.name;
      text += "\n";
    }
    text += quoted(one.area.name);
    for (const Cell& cell : cells)
      text += std::isfinite(cell.value) ? fmt::format(",{:.{}f}", cell.value, cell.digits) : ",";
    text += "\n";
  }
  return text;
}

}  // namespace

void write_areas(const AreaFiles& files, std::span<const MeasuredArea> areas, double length_sigma,
                 const std::string& crs) {
  write_together({files.csv, files.package}, [&](const std::vector<fs::path>& temporaries) {
    write_atomically(temporaries[0], csv_of(areas, length_sigma));
    write_package(temporaries[1], areas, length_sigma, crs);
  });
}

}  // namespace axial::map
