// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/map_place.h"

#include "axial/map.h"
#include "base/error.h"
#include "map/up_direction.h"

namespace axial::map {

void declare_place(OptionList& list, const std::string& drawn, PlaceOptions& options) {
  const std::string map = "a map of MapSurface on which the " + drawn +
                          " were drawn, such as scene_map.dem.tif: gives axes and coordinate "
                          "reference system";
  list.add("map", &options.map, map.c_str())
      .add("up", &options.up_text, "direction of the heights in the world, X,Y,Z (default: z)")
      .add_with_default("epsg", &options.epsg,
                        "EPSG code of the coordinate reference system of the mesh, a projected one "
                        "in metres (0: none)")
      .range(0, 1 << 20);
}

void take_place(const ParsedOptions& parsed, PlaceOptions& options) {
  options.up = parse_up(options.up_text, options.epsg);
  if (options.map.empty()) return;
  for (const char* option : {"up", "epsg"})
    if (given(parsed, option)) fail("--{} contradicts --map, which states it", option);
}

MapPlace place_of_map(const std::filesystem::path& map) {
  const StatedPlace stated = stated_place(map);
  if (!stated.axes) fail_in(map, "does not state its axes: is it a map of MapSurface?");
  return {*stated.axes, stated.crs};
}

MapPlace place_of(const PlaceOptions& options) {
  if (!options.map.empty()) return place_of_map(options.map);
  MapPlace place;
  if (options.epsg > 0) place.crs = crs_of_epsg(options.epsg);
  const Eigen::Vector3d up = options.up.value_or(Eigen::Vector3d::UnitZ());
  place.axes.axes = frame_with_up(up, {}).axes;
  return place;
}

}  // namespace axial::map
