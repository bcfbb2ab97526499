// SPDX-License-Identifier: GPL-3.0-or-later
// What changed between two surveys of the same place.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "axial/base.h"
#include "axial/geometry.h"
#include "axial/map.h"
#include "axial/scene.h"

namespace axial::compare {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// The map x -> rotation * (x - centre) + centre + translation, in map coordinates [m].
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

struct RegistrationOptions {
  int max_iterations = 60;  // largest number of steps
  int longest_side = 300;   // largest number of samples along the longer side of the map
  // Samples are left out whose residual is farther from the median than this number of robust
  // standard deviations, and so are the samples beside them.
  double outlier = 3;
};

struct Registration {
  RigidMotion motion;  // of the later survey
  // Covariance of a small further motion about the centre: rotation vector [rad], translation [m].
  // Zero along directions that the surface does not determine, and without registration.
  Matrix6d covariance = Matrix6d::Zero();
  int determined = 0;         // number of directions that the surface determines, at most 6
  int iterations = 0;         // number of steps
  bool converged = true;      // false: the iteration ended only because of `max_iterations`
  double share_used = 1;      // share of the samples with both surfaces that are not left out
  double residual_sigma = 0;  // robust standard deviation of the residuals [m]

  // The variance [m^2] of the height of the later survey at the point `place` [map], where the
  // surface has the slope `slope`, because of the uncertainty of the motion.
  double height_variance(const Eigen::Vector3d& place, const Eigen::Vector2d& slope) const;
};

// The noise of the differences of heights. The standard deviation at a pixel is that of its cell
// times the steepness of the pixel, because a surface that is displaced along its normal changes
// its height by the displacement times the steepness.
struct Noise {
  int cell = 32;                   // side of a cell [px]
  cv::Mat1f cells;                 // standard deviation on level ground [m]: of each cell
  double typical = 0;              // the same for all of the map [m]
  double lowest = 0, highest = 0;  // of `cells` [m]
  // The standard deviation on level ground that the differences between pixels a few pixels apart
  // show [m]. Noise that is similar at neighbouring pixels has less of it than `typical`, and
  // changed ground much less.
  double local = 0;
  bool is_given = false;  // by the user, for all of the map
  // The variance of the mean of many pixels, times their number, divided by the variance of one
  // pixel. 1 if the pixels are independent.
  double correlation = 1;

  // The standard deviation of a pixel on level ground [m].
  float at(int y, int x) const { return cells(y / cell, x / cell); }
};

// What the heights of two surveys tell about the places that they show.
enum class PlaceVerdict {
  same,       // the reliefs agree
  different,  // both surveys have relief, and the reliefs do not agree
  unknown     // there is too little relief, or too few common pixels
};

// The relief of a survey is its height, averaged over cells of at least 1/60 of the longer side of
// the map, minus the mean of the cells around, over 0.07 of the map. Large heights are cut off at
// three robust standard deviations. A correlation here is the median of the correlations in windows
// of 6 x 6 cells: ground that did not change decides if it is more than half of the map, however
// large the changes are.
struct PlaceAgreement {
  PlaceVerdict verdict = PlaceVerdict::unknown;
  // Correlation of the reliefs of both surveys: 1 for the same ground, about 0 for different
  // places.
  double correlation = 0;
  // The correlation below which the places are different: the smaller one of 0.6 and of 2.5 times
  // `relief`.
  double least = 0;
  // Correlation by chance: the value that one in a hundred correlations exceeds if the later map is
  // shifted, turned by half a turn or mirrored.
  double chance = 0;
  // Correlation of the reliefs with themselves one cell away: the geometric mean of both surveys.
  // Ground has about 0.24 to 0.8, and the noise of reconstructions of level ground at most 0.13.
  // Below 0.2 the verdict is `unknown`, unless `correlation` is 0.6 or more.
  double relief = 0;
};

// The classes of the pixels.
inline constexpr std::uint8_t kUnchanged = 0, kGone = 1, kCame = 2, kNotCompared = 255;

struct ChangeOptions {
  // A region of change consists of adjacent pixels whose differences have the same sign and are
  // larger than `weak` standard deviations. At least `least_pixels` of them are larger than
  // `strong` standard deviations. Pixels that touch at a corner are adjacent. These are pixels that
  // both surveys see. Then unseen pixels are added that continue the region and whose differences
  // are at most twice the median of the region, if they are at most a quarter of its seen pixels.
  // Other unseen pixels are not compared.
  double strong = 3, weak = 1.5;
  int least_pixels = 8;
  // The volume of a region includes the differences, of either sign, of the pixels around it that
  // are in no region, up to this distance [px]: noise decides which pixels at the rim are larger
  // than `weak`, so that the differences in the region alone would be too large on average.
  int rim = 2;
};

// A volume between the surveys. `volume` and `sigma` are 0 or more.
struct Volume {
  double volume = 0, sigma = 0;  // [m^3]
  double area = 0;               // of the pixels in regions, without their rims [m^2]
};

struct Region {
  bool came = false;
  Volume size;
  double x = 0, y = 0;  // mean of the places of its pixels [map]
  double largest = 0;   // largest absolute difference [m]
};

struct Changes {
  cv::Mat1b classes;
  std::vector<Region> regions;  // the largest volume first
  Volume came, gone;
  double net = 0, net_sigma = 0;  // what came minus what went [m^3]
  double area_compared = 0;       // [m^2]
};

// The photographs of the surveys, with poses in the frame of the meshes. Empty: not known.
struct SurveyPhotos {
  std::vector<geometry::PosedCamera> before, after;
  int least = 3;  // number of photographs that must see a place of a survey
};

struct CompareOptions {
  double pixel = 0;    // width of a pixel of the map [m]; 0: vertex_distance() of the coarser mesh
  bool align = false;  // move the later survey onto the ground that did not change
  // In place of `align`: the registration by which the later survey was moved before.
  std::optional<Registration> registered = {};
  RegistrationOptions registration = {};
  // Standard deviations of both surfaces along their normals [m], above 0. Empty: estimated.
  struct Sigmas {
    double before, after;
  };
  std::optional<Sigmas> sigmas = {};
  ChangeOptions changes = {};
  SurveyPhotos photos = {};
  // Whether a place on the map [m] is compared; empty: all places are. Other places only help to
  // find the registration and the noise. Called by several threads.
  std::function<bool(const Eigen::Vector2d& place)> is_inside = {};
  // Whether surveys are compared although they show different places.
  bool allow_other_place = false;
  // For the fields `pixel`, "ground_sample_distance", `photos.least`, "min_views", and
  // `allow_other_place`.
  // The names of the surveys in errors.
  std::filesystem::path name_before = "the earlier survey", name_after = "the later survey";
};

// The maps have one value for each pixel of `grid`. NaN: not compared, because one of the surveys
// has no surface there, or because too few photographs see the place.
struct Comparison {
  map::MapFrame frame;            // of the earlier survey
  map::MapGrid grid;              // the common part of the smallest grids around both surveys
  double base = 0;                // the height above which `before` is stated [map, m]
  cv::Mat1f before;               // height of the earlier survey; NaN only where it has no surface
  cv::Mat1f difference;           // later minus earlier height [m]
  cv::Mat1f sigma;                // standard deviation of the difference [m]
  double registration_sigma = 0;  // median of its part of the standard deviations [m]
  Registration registration;
  PlaceAgreement place;
  Noise noise;
  Changes changes;
  int least_pixels = 0;    // of a region, see compare_surveys()
  double area_unseen = 0;  // not compared because too few photographs see it [m^2]
};

// The square root of the area of the mesh per vertex [m]. Error for a mesh without area.
double vertex_distance(const Mesh& mesh);

// The unit normal of the plane that fits the mesh best (map::fitted_plane()), on the side of
// `facing`: the mean normal of the side of the surface that is seen.
// Error for a mesh without area, and if `facing` is 0, as that of a closed mesh.
Eigen::Vector3d upward_direction(const Mesh& mesh, const Eigen::Vector3d& facing);

// Compares two surveys. `frame`: of both meshes.
//
// If the photographs of a survey are known, places that too few of them see are compared only
// within regions of change most of which are seen: meshes go on for a little where few photographs
// look, and a place above the surface of one survey may be one that this survey did not look at.
//
// The variance of a difference is the sum of three parts. The first one is the variance of the
// noise (Noise), times the squared steepness of the steeper surface. The second one is the square
// of a quarter of the bend of the surface that bends more:
// meshes with vertices at other places cut off other parts of edges and of furrows. The bend that
// noise alone gives is subtracted first. The third one is the variance by the uncertain
// registration.
//
// If pixels are narrower than vertex_distance() of the coarser mesh, a region needs as many more
// pixels (ChangeOptions::least_pixels), because neighbouring pixels then show the same noise.
//
// Error if a mesh is none (check_mesh()), if the surveys do not overlap, if they cannot be
// aligned; these two name the later survey. Error that names both surveys if
// their reliefs show different places, unless CompareOptions::allow_other_place is set; the places
// that photographs do not see do not count. Error if the map has too many
// pixels (grid_around()), if the photographs see no place of both surveys, and if the memory does
// not suffice. Error that names the later survey if no place is inside of
// CompareOptions::is_inside. The result does not depend on the number of threads. The stages
// "Registration" (steps), "Heights" (blocks of the map, of both surveys) and "Sights" (rows of the
// map, of a survey with photographs) report their progress.
Comparison compare_surveys(const Mesh& before, const Mesh& after, const map::MapFrame& frame,
                           const CompareOptions& options, const Context& context = {});

}  // namespace axial::compare
