// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of measured polygons, for spreadsheets and GIS programs.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "map/area_measures.h"

namespace axial::map {

// A number for a table, with its name and its standard deviation. NaN: not known.
struct AreaValue {
  std::string name;
  double value = kNotKnown, sigma = kNotKnown;
  int digits = 6;         // behind the point, for `value`
  bool has_sigma = true;  // false: the table has no column for `sigma`
};

struct MeasuredArea {
  Area area;
  AreaMeasures measures;
  AreaMeasures smoothed;  // of the mesh geometry::smoothed(): what the resolution changes
  std::vector<AreaValue> more = {};  // the same names for all areas
};

// The numbers of an area, with their standard deviations, which have three parts: by the scale,
// with `length_sigma`, the standard deviation of a length as a share of it; by the resolution, the
// difference from the number of the smoothed mesh; and of the mean height and of volumes by noise
// (AreaMeasures::noise, AreaMeasures::volume_noise). That of the polygon's area is not known
// without `length_sigma`. Shares, and coordinates but the mean height, have none.
std::vector<AreaValue> values_of(const MeasuredArea& one, double length_sigma);

// Writes a row for each area, as CSV in UTF-8 with a header (docs/measure.md), and as GeoPackage
// with the polygons: values_of(), and MeasuredArea::more. A standard deviation stands in a column
// of its own. A number that is not known is left empty. `length_sigma`: 0: not known. `crs`: WKT of
// the coordinates; empty: none. The GeoPackage states 2000-01-01 as the date of its last change, so
// that the same areas give the same bytes. Both files are written together (write_together()).
// Error that names a file that cannot be written.
struct AreaFiles {
  std::filesystem::path csv, package;
};
void write_areas(const AreaFiles& files, std::span<const MeasuredArea> areas, double length_sigma,
                 const std::string& crs);

}  // namespace axial::map
