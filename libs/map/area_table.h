// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of measured polygons, for spreadsheets and GIS programs.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "map/area_measures.h"

namespace axial::map {

struct MeasuredArea {
  Area area;
  AreaMeasures measures;
};

// Writes a row for each area, as CSV in UTF-8 with a header (docs/measure.md), and as GeoPackage
// with the polygons. A number that is not known is left empty. `length_sigma`: the standard
// deviation of a length, as a share of it; 0: not known, and columns of standard deviations are
// left out. `crs`: WKT of the coordinates; empty: none. The GeoPackage states 2000-01-01 as the
// date of its last change, so that the same areas give the same bytes. Both files are written
// together (write_together()). Error that names a file that cannot be written.
struct AreaFiles {
  std::filesystem::path csv, package;
};
void write_areas(const AreaFiles& files, std::span<const MeasuredArea> areas, double length_sigma,
                 const std::string& crs);

}  // namespace axial::map
