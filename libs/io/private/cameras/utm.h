// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: from degrees on the ellipsoid WGS 84 to metres in a UTM zone.
#pragma once

#include <Eigen/Core>
#include <string>

#include "private/only_for_io.h"

namespace axial::io {

struct UtmZone {
  int number = 0;  // 1 to 60
  bool south = false;

  int epsg() const { return (south ? 32700 : 32600) + number; }
  std::string name() const;  // such as "WGS 84 / UTM zone 33N"
};

// The zone of a place, by the regular division into stripes of six degrees. Arguments in degrees.
UtmZone utm_zone(double longitude, double latitude);

// Easting and northing [m] of a place. Arguments in degrees, latitude from -84 to 84, longitude
// within a few degrees of the zone (the error is below 0.001 mm within 10 degrees). Formula:
// Krüger's series to the fourth order in n (C. F. F. Karney, Transverse Mercator with an accuracy
// of a few nanometers, Journal of Geodesy 85, 2011, equations 7 to 12 and 35).
Eigen::Vector2d to_utm(double longitude, double latitude, const UtmZone& zone);

}  // namespace axial::io
