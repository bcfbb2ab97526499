// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/control: systems of coordinates, by GDAL and PROJ.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace axial::control {

class CoordinateSystem {
 public:
  // `text`: "EPSG:N", WKT, PROJ's "+proj=...", or "WGS84 UTM 16N". Nothing if it is no system that
  // PROJ knows. No file and no network is used for the text.
  static std::optional<CoordinateSystem> from_text(const std::string& text);

  // "EPSG:N", or WKT if the system has no code. Empty for a local system.
  const std::string& name() const { return name_; }
  std::string wkt() const;
  bool is_local() const;
  bool is_geographic() const;  // its coordinates are longitude and latitude [degrees]
  bool is_metric() const;      // projected or local, with metres as unit
  // The length on the map of one metre on the ellipsoid at `place` (x and y): the mean of the
  // lengths along x and y of the map. 1 for a system that is not projected. Not finite if no place
  // on the ellipsoid is there.
  double map_scale(const Eigen::Vector2d& place) const;

 private:
  CoordinateSystem() = default;
  std::shared_ptr<void> system_;
  std::string name_;
  friend std::vector<Eigen::Vector2d> transformed(std::span<const Eigen::Vector2d>,
                                                  const CoordinateSystem&, const CoordinateSystem&);
};

// x and y (longitude and latitude) in another system. A place without an image there has
// coordinates that are not finite. Neither system is local.
std::vector<Eigen::Vector2d> transformed(std::span<const Eigen::Vector2d> places,
                                         const CoordinateSystem& from, const CoordinateSystem& to);

// "EPSG:N" of the UTM zone on WGS 84, by the regular division into stripes of six degrees.
std::string utm_zone(double longitude, double latitude);

}  // namespace axial::control
