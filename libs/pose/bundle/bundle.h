// SPDX-License-Identifier: GPL-3.0-or-later
// The input of refractive bundle adjustment: cameras, poses, points and observations. Coordinates
// are in the world frame, in metres unless a function accepts another unit. Pixel centres are at
// integers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "axial/scene.h"
#include "pose/bundle/housing_change.h"
#include "pose/bundle/rig.h"
#include "scene/decompositions.h"

namespace axial::pose {

// A camera, which several images may share.
struct BundleCamera {
  HousedCamera measured;  // lens in air and port, as measured before the adjustment
  // The present minus the measured numbers of lens and port (housing_change.h lists them).
  HousingChange<double> change = HousingChange<double>::Zero();
  // The standard deviations that the files of lens and housing state for the measured numbers, in
  // the units of `change`. 0: not stated.
  HousingChange<double> stated_sigma = HousingChange<double>::Zero();
  // The index in Bundle::cameras of an earlier camera with the same lens and port, which took
  // photographs of another size. `change` is then that of the earlier camera: adjust() shares it.
  std::optional<std::size_t> same_as = std::nullopt;

  // The camera with the change applied.
  HousedCamera now() const { return with_change(measured, change); }
};

// A photograph and its pose.
struct BundleImage {
  std::string name;        // the image's name in the COLMAP model
  std::size_t camera = 0;  // index into Bundle::cameras
  Pose pose;
};

// A point in the water.
struct BundlePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::size_t source = 0;  // the point's id in the COLMAP model
  // True: the centre of a coded target (target_points.h). `source` is then larger than all ids of
  // the model.
  bool is_target = false;
};

// A measured image of a point.
struct Observation {
  std::size_t image = 0;                            // index into Bundle::images
  std::size_t point = 0;                            // index into Bundle::points
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // [px] of the photograph
  std::size_t source = 0;  // index in ColmapImage::points of the COLMAP model
  float size = 0;          // scale of the feature [px]; 0: not known
  // The standard deviation of the pixel as a multiple of AdjustOptions::pixel_sigma, above 0.
  double sigma = 1;
  // The standard deviation of each coordinate of the centre of a target [px], which applies instead
  // of `sigma`. 0: the observation of a feature.
  double target_sigma = 0;
};

// The input and the result of adjust() (adjust.h).
struct Bundle {
  std::vector<BundleCamera> cameras;
  std::vector<BundleImage> images;
  std::vector<BundlePoint> points;
  std::vector<Observation> observations;
  std::vector<Rig> rigs = {};  // cameras that are mounted together
};

// The cameras of the bundle with their changes applied, in the order of Bundle::cameras.
std::vector<PhotographCamera> cameras_now(const Bundle& bundle);

// The index into Bundle::points of the point whose BundlePoint::source is `source`. Error if there
// is no such point, for example because the point was dropped.
std::size_t point_of(const Bundle& bundle, std::size_t source);

// The number of observations in each image, in the order of Bundle::images.
std::vector<std::size_t> observations_by_image(const Bundle& bundle);

// Moves all poses and points.
void move_places(Bundle& bundle, const Similarity& similarity);

// True if the bundle has points that are targets.
bool has_targets(const Bundle& bundle);

// The indices of the observations of each of `count` images or points, in ascending order. `of`:
// &Observation::image or &Observation::point.
std::vector<std::vector<std::size_t>> observations_of_each(
    std::span<const Observation> observations, std::size_t Observation::*of, std::size_t count);

// The part of the bundle that has the points with the most observations in the images for which
// `takes` is true: at most `most` points, those with the most observations first, and only points
// with `least` observations or more that are no targets. All cameras and images stay.
Bundle most_observed(const Bundle& bundle, std::size_t most, std::size_t least,
                     const std::function<bool(std::size_t image)>& takes);

// The reprojection error [px of the photograph] of a point [world] at `pixel`. Infinite if the
// point has no image (PhotographImage::visible is false).
double reprojection_error(const PhotographCamera& camera, const Pose& pose,
                          const Eigen::Vector3d& point, const Eigen::Vector2d& pixel);

// The reprojection errors [px of the photograph] of all observations, in the order of the
// observations.
std::vector<double> reprojection_errors(const Bundle& bundle);

// The median, over all observations, of the distance [m] from the camera centre to the point.
// Throws an Error if the bundle has no observations.
double median_distance(const Bundle& bundle);

// The reprojection errors [px of the photograph] in one list for each image, in the order of
// Bundle::images. Within a list, the errors have the order of the observations. The list of an
// image without observations is empty.
std::vector<std::vector<double>> reprojection_errors_by_image(const Bundle& bundle);

// The square root of the mean of the squared finite `errors`. 0 if no error is finite.
double root_mean_square(std::span<const double> errors);

}  // namespace axial::pose
