// SPDX-License-Identifier: GPL-3.0-or-later
// Profiles of heights along lines on a map.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "axial/map.h"

namespace axial::map {

struct ProfileLine {
  std::string name;
  std::vector<Eigen::Vector2d> corners;  // [map, m], two or more
};

// The lines of a GeoJSON, GeoPackage or shape file that lie on the map with the grid `grid`, in
// their order. Names, and coordinates in other systems, are those of read_areas(). The parts of a
// line get its name and their number, from 1. Error that names the file, and the line: the file
// cannot be read; it has no layer with lines, or several; a feature is no line; a line has no
// length; a coordinate is not finite, cannot be converted, or is not on the map.
std::vector<ProfileLine> read_lines(const std::filesystem::path& file, const std::string& crs,
                                    const MapGrid& grid);

// The same without the map, to find faults of the file before long work.
std::vector<ProfileLine> read_lines(const std::filesystem::path& file, const std::string& crs);

struct ProfileFiles {
  std::filesystem::path table;    // CSV
  std::filesystem::path package;  // GeoPackage
  std::filesystem::path drawing;  // DXF
};

// Writes the heights along lines on the map of heights `heights`, which GeoTiff wrote. The points
// of a profile are the corners of its line, and points between them whose distance along the line
// is a multiple of the width of a pixel. A height is interpolated (bilinear) between the centres of
// four pixels; it is unknown if one of them has no surface. Within half a pixel of the border of
// the map the height is that at the nearest place between centres.
// The table has a row for each point: profile, distance_m (in the plane of the map), x, y, height_m
// (empty: unknown). GeoPackage and DXF have the same points with heights as lines, which are
// interrupted where heights are unknown; a profile without two neighbouring heights has no line.
// The GeoPackage states the reference system of the map. The files are written in place. Error
// that names the file that cannot be read or written.
void write_profiles(const std::filesystem::path& heights, std::span<const ProfileLine> lines,
                    const ProfileFiles& files);

}  // namespace axial::map
