// SPDX-License-Identifier: GPL-3.0-or-later
// Standard deviations and covariances of the results of refractive bundle adjustment.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "base/context.h"
#include "pose/bundle/adjust_options.h"

namespace axial::pose {

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
