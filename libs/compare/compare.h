// SPDX-License-Identifier: GPL-3.0-or-later
// What changed between two surveys of the same place.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "base/context.h"
#include "base/setting_names.h"
#include "compare/changes.h"
#include "compare/noise.h"
#include "compare/registration.h"
#include "compare/same_place.h"
#include "map/frame.h"
#include "map/pixel_width.h"
#include "map/write_maps.h"
#include "scene/mesh.h"

namespace axial::compare {

// The photographs of the surveys, with poses in the frame of the meshes. Empty: not known.
struct SurveyPhotos {
  std::vector<geometry::PosedCamera> before, after;
  int least = 3;  // number of photographs that must see a place of a survey
};

struct CompareOptions {
  double pixel = 0;    // width of a pixel of the map [m]; 0: vertex_distance() of the coarser mesh
  bool align = false;  // move the later survey onto the ground that did not change
  RegistrationOptions registration = {};
  // Standard deviations of both surfaces along their normals [m], above 0. Empty: estimated.
  struct Sigmas {
    double before, after;
  };
  std::optional<Sigmas> sigmas = {};
  ChangeOptions changes = {};
  SurveyPhotos photos = {};
  // Whether surveys are compared although they show different places (compare/same_place.h).
  bool allow_other_place = false;
  // For the fields `pixel`, "ground_sample_distance", `photos.least`, "min_views", and
  // `allow_other_place`.
  SettingNames name_of = own_name;
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

// The mean of the unit normals of the faces, weighted by area. Error for a mesh without area.
Eigen::Vector3d mean_normal(const Mesh& mesh);

// The unit normal of the plane that fits the mesh best (map::fitted_plane()), on the side of
// `facing`: the mean normal of the side of the surface that is seen, from geometry::SeenPart or
// from mean_normal(). Error for a mesh without area, and if `facing` is 0, as that of a closed
// mesh.
Eigen::Vector3d upward_direction(const Mesh& mesh, const Eigen::Vector3d& facing);

// Compares two surveys. `frame`: of both meshes.
//
// If the photographs of a survey are known, places that too few of them see (mark_unseen() in
// compare/visibility.h) are compared only within regions of change most of which are seen: meshes
// go on for a little where few photographs look, and a place above the surface of one survey may be
// one that this survey did not look at.
//
// The variance of a difference is the sum of three parts. The first one is the variance of the
// noise (Noise), times the squared steepness of the steeper surface. The second one is the square
// of a quarter of the bend of the surface that bends more (bend_at() in compare/height_map.h):
// meshes with vertices at other places cut off other parts of edges and of furrows. The bend that
// noise alone gives is subtracted first. The third one is the variance by the uncertain
// registration.
//
// If pixels are narrower than vertex_distance() of the coarser mesh, a region needs as many more
// pixels (ChangeOptions::least_pixels), because neighbouring pixels then show the same noise.
//
// Error if a mesh is none (check_mesh()), if the surveys do not overlap, if they cannot be
// aligned (register_surveys()); these two name the later survey. Error that names both surveys if
// their reliefs show different places, unless CompareOptions::allow_other_place is set; the places
// that photographs do not see do not count. Error if the map has too many
// pixels (grid_around()), if the photographs see no place of both surveys, and if the memory does
// not suffice. The result does not depend on the number of threads. The stages "Registration"
// (steps), "Heights" (blocks of the map, of both surveys) and "Sights" (rows of the map, of a
// survey with photographs) report their progress.
Comparison compare_surveys(const Mesh& before, const Mesh& after, const map::MapFrame& frame,
                           const CompareOptions& options, const Context& context = {});

}  // namespace axial::compare
