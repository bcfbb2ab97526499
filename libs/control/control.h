// SPDX-License-Identifier: GPL-3.0-or-later
// What surveyors know about targets: where they are, how long bars are, and where photographs show
// them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace axial::control {

// The standard deviation of a coordinate that is not known.
inline constexpr double kNotKnown = std::numeric_limits<double>::infinity();

// A target whose place in the world is known, or a part of its coordinates.
struct ControlPoint {
  std::string label;  // of the target, such as "target 7"
  // x (east), y (north), z (up) [m], in the system of coordinates of Control::crs. 0 where the
  // coordinate is not known.
  Eigen::Vector3d metres = Eigen::Vector3d::Zero();
  // Standard deviations of the coordinates [m], above 0; kNotKnown: the coordinate is not known.
  Eigen::Vector3d sigma = Eigen::Vector3d::Constant(kNotKnown);
  // True: the point is a check. It does not enter the adjustment, and its error is reported.
  bool check = false;
  std::string where;  // "control.csv:3", for messages

  bool knows(int coordinate) const { return sigma(coordinate) < kNotKnown; }
};

// The known distance between the centres of two targets.
struct Bar {
  std::string first, second;  // labels
  double metres = 0;          // [m], above 0
  double sigma = 0;           // standard deviation [m], above 0
  bool check = false;         // as ControlPoint::check
  std::string where;
};

// A target in a photograph.
struct TargetImage {
  std::string label;
  std::string image;  // the name of the photograph as the file states it
  // [px]. The corner of the first pixel is (0, 0), its centre is (0.5, 0.5), as in COLMAP.
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  // Standard deviation of each coordinate [px]; 0: the file states none.
  double sigma = 0;
  // Ring: the symmetric matrix [1/px] that maps the ellipse of the dot, whose centre is `pixel`, to
  // the unit circle. Zero: no ring.
  Eigen::Matrix2d dot = Eigen::Matrix2d::Zero();
  // Square: its corners [px]; `pixel` is the intersection of the diagonals.
  std::optional<std::array<Eigen::Vector2d, 4>> corners;
  std::string where;
};

// The contents of one or more files.
struct Control {
  std::vector<TargetImage> images;
  std::vector<ControlPoint> points;
  std::vector<Bar> bars;
  std::string crs;                 // of `points`: "EPSG:32617"; empty: not stated, metres
  double map_scale = 1;            // the length on the map of `crs` of one metre on the ellipsoid
  std::vector<std::string> notes;  // how files were understood, a line for each decision
};

}  // namespace axial::control
