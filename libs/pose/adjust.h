// SPDX-License-Identifier: GPL-3.0-or-later
// Refractive bundle adjustment.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/context.h"
#include "pose/bundle.h"

namespace axial::pose {

// A known length between two camera centres or between two points.
struct KnownDistance {
  enum class Between { images, points } between = Between::images;
  // The two ends. Between images: indices into Bundle::images. Between points: values of
  // BundlePoint::source.
  std::size_t first = 0, second = 0;
  double metres = 0;  // the length [m], above 0
  double sigma = 0;   // standard deviation [m], above 0
  // The name of a bar between two targets, for messages. A bar has a Huber loss: deviations of more
  // than three standard deviations count linearly. Empty: any other length.
  std::string name = {};
};

// A point or a camera centre of which some or all coordinates are known.
struct KnownPlace {
  KnownDistance::Between of = KnownDistance::Between::points;
  std::size_t index = 0;                             // as KnownDistance::first
  Eigen::Vector3d metres = Eigen::Vector3d::Zero();  // the place [m], world frame, z upwards
  // Standard deviations of the coordinates [m], above 0. Infinite: the coordinate is not known.
  Eigen::Vector3d sigma = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  std::string name = {};  // for messages

  bool knows(int coordinate) const { return std::isfinite(sigma(coordinate)); }
  bool knows_all() const { return sigma.allFinite(); }
};

// A known camera centre.
struct KnownPosition {
  std::size_t image = 0;                             // index into Bundle::images
  Eigen::Vector3d metres = Eigen::Vector3d::Zero();  // the centre [m], world frame
  // Standard deviations of the coordinates [m], above 0.
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  // True: nobody stated `sigma`. adjust() uses it all the same, and refine() replaces it by an
  // estimate.
  bool sigma_is_guess = false;
};

// Which numbers of a camera are unknown. housing_change.h lists the numbers by index, with their
// units.
struct Unknowns {
  std::array<bool, kHousingNumbers> free{};  // true: adjust() may change the number
  // The standard deviations with which the numbers were measured, in the units of the numbers. 0:
  // BundleCamera::stated_sigma applies, or if that is 0, too, `default_sigma`. If all three are 0,
  // the number was not measured.
  std::array<double, kHousingNumbers> prior_sigma{};
  std::array<double, kHousingNumbers> default_sigma{};
};

// What adjust() knows and what it may change. The members of Unknowns apply to all cameras, with
// the exceptions `of_domes` and `of_air`.
struct AdjustOptions : Unknowns {
  // The unknowns of cameras behind domes, and of cameras in air. Empty: the unknowns of this struct
  // apply to them as to all other cameras. Domes can have unknowns of their own, because the first
  // three numbers of a dome and of a flat port have different meanings. Cameras in air have only
  // the focal length.
  std::optional<Unknowns> of_domes, of_air;

  // Free numbers that adjust() leaves as they are nevertheless, by index of the camera. Empty:
  // none.
  std::vector<std::array<bool, kHousingNumbers>> kept;
  bool keeps(std::size_t camera, std::size_t number) const {
    return !kept.empty() && kept[camera][number];
  }

  // The unknowns that apply to `camera`.
  const Unknowns& unknowns(const BundleCamera& camera) const;
  // The standard deviation with which `number` of `camera` was measured (Unknowns). 0: not
  // measured.
  double sigma_before(const BundleCamera& camera, int number) const;

  // Known lengths and positions enter the cost. adjust() says which poses stay constant.
  std::vector<KnownDistance> distances;
  std::vector<KnownPosition> positions;
  std::vector<KnownPlace> places;
  // True if these determine the scale at the start (bring_to_metres()): a distance, three
  // positions, or x and y of two places.
  bool know_lengths() const;
  bool points_known = false;  // true: all points stay constant
  bool poses_known = false;   // true: all poses stay constant

  // The standard deviation of the x and of the y of an observation with Observation::sigma 1 [px].
  double pixel_sigma = 1;
  // The standard deviation of the x and of the y of `observation` [px].
  double sigma_of(const Observation& observation) const {
    return observation.target_sigma > 0 ? observation.target_sigma
                                        : observation.sigma * pixel_sigma;
  }
  double loss_sigmas = 2;  // Huber loss: errors above this many standard deviations count linearly
  int max_iterations = 100;  // of the solver

  // The bundle comes from an adjustment of nearly the same problem. adjust() then starts with steps
  // that are hardly damped.
  bool starts_close = false;

  // If at least `many_images` poses are adjusted, adjust() starts with steps that are hardly
  // damped, and ends when an iteration lowers half the cost by less than `least_gain`. A step of
  // one standard deviation along any direction lowers half the cost by 0.5. The default therefore
  // corresponds to a step of 0.014 standard deviations.
  std::size_t many_images = 500;
  double least_gain = 1e-4;
  // Otherwise adjust() ends when two iterations in a row, with the least damping, each lower half
  // the cost by less than this: steps of 0.14 standard deviations. A point whose observations are
  // all outliers moves by short steps of equal lengths, which hardly change the cost, but may take
  // all iterations. 0: adjust() goes on.
  double gain_of_outliers = 0.01;
};

// The state of an adjustment after an iteration of the solver.
struct AdjustIteration {
  int number = 0;      // 0: the evaluation of the start
  double cost = 0;     // half the cost of adjust()
  double seconds = 0;  // that the iteration took
};

// Receives the state after each iteration, in the thread of the caller.
using AdjustSink = std::function<void(const AdjustIteration&)>;

// How the solver ended.
struct AdjustReport {
  // False: it stopped at max_iterations, and the last one lowered half the cost by
  // AdjustOptions::gain_of_outliers or more.
  bool converged = false;
  int iterations = 0;                       // including the evaluation of the start
  double initial_cost = 0, final_cost = 0;  // half the cost of adjust()
};

// Refractive bundle adjustment: changes the poses, the points and the free numbers of the cameras
// (BundleCamera::change) to minimize the cost, from their present values. The cost is the sum of
// the squared reprojection errors of the exact projection (with Huber loss, in units of
// `pixel_sigma` times Observation::sigma) and of the squared deviations from known distances,
// positions, places, measured numbers and stated poses in rigs (in their standard deviations).
// Positions and places have a Huber loss, too: deviations of more than three standard deviations
// count linearly. The deviation of the photographs of a frame from their rig (rig.h) has Cauchy's
// loss with the scale 4.1, so that a photograph of another frame counts little.
//
// Without knowledge of positions, places, points or poses, the cost does not depend on where the
// model is in the world. The pose of one image therefore stays constant: of the first image with an
// observation or with a known distance or position. Exceptions: with three or more known positions
// or with known points, this pose is adjusted like all others, and with known poses, all poses stay
// constant. With known places, no pose stays constant, but motions of the whole model that change
// no known coordinate (free_motions.h) are excluded: the pose of this image does not follow them.
// Poses of images and positions of points that do not enter the cost stay unchanged. The solver
// runs in one thread, because sums over several threads would depend on the order of the threads.
//
// The solver factorises the normal equations with the points eliminated. Its memory and the time of
// an iteration depend on the pairs of images with common points. AdjustOptions::many_images says
// how bundles of many images are solved in fewer iterations. `sink` may be empty.
//
// A measured distance of a flat port does not become negative, and a measured index of the water
// not less than that of the air.
//
// Throws an Error if a number of a port is free for a camera in air, if a known length, a standard
// deviation of known values or `pixel_sigma` is not positive, if a known distance names a point
// that the bundle does not have, if the bundle has no observations, or if the solver fails. After
// an Error, or after a stop, the bundle is unchanged. Precondition: all indices are in their range.
AdjustReport adjust(Bundle& bundle, const AdjustOptions& options, const AdjustSink& sink = {},
                    const Context& context = {});

// Estimates the standard deviation of the observations of features [px] from their reprojection
// errors. Let N be the number of these observations, S the sum of their squared errors, each
// divided by Observation::sigma, and U the number of unknowns: 6 for each pose of an image with
// observations, except constant poses; 3 for each point that is no target, unless points
// are known; and 1 for each free number of each camera. The result is sqrt(S / max(1, 2 N - U)),
// and at least 1e-9 px.
// Infinite errors count with the mean square of the finite errors.
double observed_pixel_sigma(const Bundle& bundle, const AdjustOptions& options);

// Standard deviations of the results of bundle adjustment: the result of uncertainty().
struct Uncertainty {
  double pixel_sigma = 0;  // of the observations [px], by observed_pixel_sigma()
  // One vector for each camera of the bundle, in their order, with the numbers and units of
  // housing_change.h. The standard deviation of a free number is infinite if nothing determines the
  // number. Numbers that are not free have 0.
  std::vector<HousingChange<double>> camera_sigmas;
  // The relative standard deviation of the scale. It is computed for one length: the distance from
  // the first image with an observation or with a known distance or position to the farthest other
  // image of this kind. It includes the effect of the errors of measured numbers that are not free
  // (AdjustOptions::sigma_before). Infinite if there is no such length, or if nothing determines
  // the scale, for example for cameras in air. 0 if poses are known.
  double scale_sigma = 0;
  // The standard deviation of the camera centres relative to each other: the root mean square of
  // sigmas_after_similarity() (shape_sigma.h) for up to 16 images, spread evenly over the images
  // with observations, divided by median_distance(). It is large where few points link the
  // images, for example along strips with little overlap. Errors of measured numbers that are not
  // free are not included: they have another cause, and another remedy.
  // Infinite if nothing determines it. 0 if poses are known, or with fewer than three images.
  double shape_sigma = 0;
  std::size_t least_linked = 0;  // the image with the largest part in `shape_sigma`
  // Of the poses of the cameras in their rigs, in the order of Bundle::rigs and Rig::cameras. 0:
  // fixed. Infinite: nothing determines it.
  std::vector<std::vector<RigSigma>> rig_sigmas;
  // depth_sigma() (depth_sigma.h); 0 if poses are known. uncertainty() does not compute it.
  double depth_sigma = 0;
};

// Returns the first-order standard deviations of the result of adjust(), from the normal equations
// with the points eliminated. Precondition: adjust() was called for `bundle` with the same
// `options`. The observations are weighted with their observed standard deviation and not with
// `options.pixel_sigma`. With AdjustOptions::many_images or more images, `context` gets the start
// of each part of the work.
Uncertainty uncertainty(const Bundle& bundle, const AdjustOptions& options,
                        const Context& context = {});

// A point or an image of a bundle: KnownPlace::of and KnownPlace::index.
struct PlaceIndex {
  KnownDistance::Between of = KnownDistance::Between::points;
  std::size_t index = 0;

  bool operator==(const PlaceIndex&) const = default;
};

// The covariance [m^2] of places, by the same equations as uncertainty(): three rows and columns
// for each place. It includes the errors of measured numbers that are not free. The variance of a
// coordinate that nothing determines is infinite. Precondition: each point is a target or has a
// known distance to another point.
Eigen::MatrixXd covariance_of_places(const Bundle& bundle, const AdjustOptions& options,
                                     std::span<const PlaceIndex> places);

// Free numbers of cameras, and their covariance in the units of housing_change.h.
struct NumbersCovariance {
  struct Number {
    std::size_t camera = 0;  // index into Bundle::cameras
    int index = 0;           // of the number in housing_change.h
  };
  std::vector<Number> numbers;
  Eigen::MatrixXd covariance;
};

// The covariance of the free numbers of all cameras, by the same equations as uncertainty(), with
// AdjustOptions::kept as if it were empty. Numbers of cameras with BundleCamera::same_as and
// numbers that nothing determines are left out.
NumbersCovariance covariance_of_numbers(const Bundle& bundle, const AdjustOptions& options);

}  // namespace axial::pose
