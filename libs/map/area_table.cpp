// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/area_table.h"

#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <cmath>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "private/csv.h"
#include "private/polygon_shapes.h"
#include "private/vector_output.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

enum class Sigma { none, by_scale, by_resolution };

struct Column {
  const char* name;
  double (*value)(const AreaMeasures& found);
  int digits;
  Sigma sigma = Sigma::none;
  int power = 0;  // of a length
  double (*noise)(const AreaMeasures& found) = [](const AreaMeasures&) { return 0.0; };
};

// The standard deviation of the mean height by noise.
double noise_of_mean(const AreaMeasures& m) {
  return m.noise * m.spacing * m.seen / std::pow(m.planar, 1.5);
}

double noise_of_volume(const AreaMeasures& m) {
  return m.volume_noise;
}

constexpr Column kColumns[] = {
    {"polygon_m2", [](const AreaMeasures& m) { return m.polygon; }, 6, Sigma::by_scale, 2},
    {"planar_m2", [](const AreaMeasures& m) { return m.planar; }, 6, Sigma::by_resolution, 2},
    {"seen_m2", [](const AreaMeasures& m) { return m.seen; }, 6, Sigma::by_resolution, 2},
    {"surface_m2", [](const AreaMeasures& m) { return m.surface; }, 6, Sigma::by_resolution, 2},
    {"rugosity", [](const AreaMeasures& m) { return m.rugosity(); }, 5, Sigma::by_resolution},
    {"rugosity_whole", [](const AreaMeasures& m) { return m.whole_rugosity(); }, 5,
     Sigma::by_resolution},
    {"rugosity_on_slope", [](const AreaMeasures& m) { return m.rugosity_on_slope(); }, 5,
     Sigma::by_resolution},
    {"slope_degrees", [](const AreaMeasures& m) { return m.slope_degrees(); }, 3},
    {"aspect_degrees", [](const AreaMeasures& m) { return m.aspect_degrees(); }, 2},
    {"lowest_m", [](const AreaMeasures& m) { return m.lowest; }, 4},
    {"mean_height_m", [](const AreaMeasures& m) { return m.plane.level; }, 4, Sigma::by_resolution,
     0, noise_of_mean},
    {"highest_m", [](const AreaMeasures& m) { return m.highest; }, 4},
    {"relief_m", [](const AreaMeasures& m) { return m.highest - m.lowest; }, 4,
     Sigma::by_resolution, 1},
    {"roughness_m", [](const AreaMeasures& m) { return m.roughness(); }, 5, Sigma::by_resolution,
     1},
    {"volume_above_m3", [](const AreaMeasures& m) { return m.above; }, 6, Sigma::by_resolution, 3,
     noise_of_volume},
    {"volume_below_m3", [](const AreaMeasures& m) { return m.below; }, 6, Sigma::by_resolution, 3,
     noise_of_volume},
    {"rim_share", [](const AreaMeasures& m) { return m.rim; }, 3},
    {"spacing_m", [](const AreaMeasures& m) { return m.spacing; }, 5},
    {"noise_m", [](const AreaMeasures& m) { return m.noise; }, 6}};

bool has_sigma(const Column& column, double length_sigma) {
  return column.sigma == Sigma::by_resolution ||
         (column.sigma == Sigma::by_scale && length_sigma > 0);
}

double sigma_of(const Column& column, const MeasuredArea& one, double length_sigma) {
  const double value = column.value(one.measures);
  const double by_scale = value * column.power * length_sigma;
  if (column.sigma == Sigma::by_scale) return std::abs(by_scale);
  const double by_resolution = value - column.value(one.smoothed);
  return std::hypot(by_scale, by_resolution, column.noise(one.measures));
}

struct Cell {
  std::string name;
  double value;  // NaN: not known
  int digits;
};

// The cells of a row behind its name. Names are the same for all rows.
std::vector<Cell> cells_of(const MeasuredArea& one, double length_sigma) {
  std::vector<AreaValue> values = values_of(one, length_sigma);
  values.insert(values.end(), one.more.begin(), one.more.end());
  std::vector<Cell> cells;
  for (const AreaValue& value : values) {
    cells.push_back({value.name, value.value, value.digits});
    if (value.has_sigma) cells.push_back({"sigma_" + value.name, value.sigma, value.digits + 1});
  }
  return cells;
}

bool add_feature(OGRLayerH layer, const MeasuredArea& one, std::span<const Cell> cells) {
  const Feature feature(OGR_F_Create(OGR_L_GetLayerDefn(layer)));
  OGR_F_SetFieldString(feature.get(), 0, one.area.name.c_str());
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (std::isfinite(cells[i].value))
      OGR_F_SetFieldDouble(feature.get(), static_cast<int>(i) + 1, cells[i].value);
  OGR_F_SetGeometry(feature.get(), shape_of_parts(one.area.parts).get());
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
    for (const Cell& cell : cells_of(areas.front(), length_sigma))
      works = works && add_field(layer, cell.name.c_str(), OFTReal);
  for (const MeasuredArea& one : areas)
    works = works && add_feature(layer, one, cells_of(one, length_sigma));
  data.reset();
  errors.require_written(works, file);
}

std::string csv_of(std::span<const MeasuredArea> areas, double length_sigma) {
  std::string text;
  for (const MeasuredArea& one : areas) {
    const std::vector<Cell> cells = cells_of(one, length_sigma);
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

std::vector<AreaValue> values_of(const MeasuredArea& one, double length_sigma) {
  std::vector<AreaValue> values;
  for (const Column& column : kColumns) {
    AreaValue value{column.name, column.value(one.measures), kNotKnown, column.digits, false};
    value.has_sigma = has_sigma(column, length_sigma);
    if (value.has_sigma) value.sigma = sigma_of(column, one, length_sigma);
    values.push_back(std::move(value));
  }
  return values;
}

void write_areas(const AreaFiles& files, std::span<const MeasuredArea> areas, double length_sigma,
                 const std::string& crs) {
  write_together({files.csv, files.package}, [&](const std::vector<fs::path>& temporaries) {
    write_atomically(temporaries[0], csv_of(areas, length_sigma));
    write_package(temporaries[1], areas, length_sigma, crs);
  });
}

}  // namespace axial::map
