// SPDX-License-Identifier: GPL-3.0-or-later
// Where the coordinates of a user's map lie: options that several programs have.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>

#include "base/program/option_list.h"
#include "base/program/program.h"
#include "map/world_axes.h"

namespace axial::map {

// The values of the options.
struct PlaceOptions {
  std::filesystem::path map;          // a map of MapSurface; empty: not given
  std::string up_text;                // of `up`, as it was given
  std::optional<Eigen::Vector3d> up;  // in the world, without a map; empty: z
  int epsg = 0;                       // without a map; 0: no coordinate reference system
};

// Adds the options `--map`, `--up` and `--epsg` to `list`. `drawn`: the things on the map, for the
// help ("polygons"). `options` must exist until parse_options() has returned. The program then
// calls take_place().
void declare_place(OptionList& list, const std::string& drawn, PlaceOptions& options);

// Converts the direction. Error if an option contradicts the map, and for a direction that
// parse_up() refuses.
void take_place(const ParsedOptions& parsed, PlaceOptions& options);

// The axes of the map, and its coordinate reference system as WKT (empty: none).
struct MapPlace {
  WorldAxes axes;
  std::string crs;
};

// The motion that aligns the later survey of a comparison of CompareSurveys (.change.json), from
// its world to that of the earlier survey. Error that names the file if it cannot be read, and for
// a matrix that is no rotation with a translation.
Eigen::Isometry3d motion_of_comparison(const std::filesystem::path& file);

// The axes for points that the motion moves first.
WorldAxes after(const Eigen::Isometry3d& motion, const WorldAxes& axes);

// The place of a map of MapSurface, or, if the name ends with ".json", of the map of a comparison,
// for the world of the later survey. Error that names the file if it cannot be read or does not
// state its axes.
MapPlace place_of_map(const std::filesystem::path& map);

// The frame of a mesh on a map.
MapFrame frame_on(const WorldAxes& axes, const LocalFrame& mesh_frame);

// Errors of place_of_map() and crs_of_epsg() are passed on.
MapPlace place_of(const PlaceOptions& options);

}  // namespace axial::map
