// SPDX-License-Identifier: GPL-3.0-or-later
// Refractive bundle adjustment.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pose/bundle.h"

namespace axial::pose {

// A known length between two camera centres or between two points.
struct KnownDistance {
  enum class Between { images, points } between = Between::images;
  // Between images: indices into Bundle::images. Between points: values of BundlePoint::source.
  std::size_t first = 0, second = 0;
  double metres = 0;  // [m], above 0
  double sigma = 0;   // standard deviation [m], above 0
};

// A known camera centre.
struct KnownPosition {
  std::size_t image = 0;                             // index into Bundle::images
  Eigen::Vector3d metres = Eigen::Vector3d::Zero();  // [m], world frame
  double sigma = 0;                                  // standard deviation [m], above 0
};

// free: whether each number of a camera (housing_change.h) is unknown. prior_sigma: the standard
// deviation with which each number was measured, in the number's unit; 0: not measured.
struct Unknowns {
  std::array<bool, kHousingNumbers> free{};
  std::array<double, kHousingNumbers> prior_sigma{};
};

struct AdjustOptions : Unknowns {  // the unknowns of all cameras; see of_domes
  // The unknowns of cameras behind domes. Empty: the same as for all other cameras. Domes can have
  // unknowns of their own, because the first three numbers of a dome and of a flat port have
  // different meanings.
  std::optional<Unknowns> of_domes;

  // The unknowns that apply to `camera`.
  const Unknowns& unknowns(const BundleCamera& camera) const;

  std::vector<KnownDistance> distances;
  std::vector<KnownPosition> positions;  // three or more also fix the model's place
  bool points_known = false;             // points stay where they are and fix the model's place
  bool poses_known = false;              // poses stay where they are and fix the model's place

  double pixel_sigma = 1;  // standard deviation of the observations [px]
  double loss_sigmas = 2;  // Huber loss: errors above this times pixel_sigma count linearly
  int max_iterations = 100;
};

struct AdjustReport {
  bool converged = false;
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;  // half the sum of squares, after the Huber loss
};

// Refractive bundle adjustment: changes the poses, the points and the free numbers of the cameras
// to minimize the cost. The cost is the sum of the squared reprojection errors of the exact
// projection (with Huber loss, in units of `pixel_sigma`) and of the squared deviations from
// known distances, positions and measured numbers (in their standard deviations).
//
// The pose of the first image with observations stays constant, unless three known positions,
// known points or known poses fix the model's place. The solver runs in one thread, because sums
// over several threads would depend on the order of the threads.
//
// Throws an Error if a number of a port is free for a camera in air, if a known length, a
// standard deviation of known values or `pixel_sigma` is not positive, if a known distance names
// a point that the bundle does not have, if the bundle has no observations, or if the solver
// fails.
AdjustReport adjust(Bundle& bundle, const AdjustOptions& options);

// Estimates the standard deviation of the observations [px] from their reprojection errors. Let N
// be the number of observations, S the sum of their squared errors, and U the number of unknowns.
// The result is sqrt(S / max(1, 2 N - U)), and at least 1e-9 px. Infinite errors count with the
// mean square of the finite errors.
double observed_pixel_sigma(const Bundle& bundle, const AdjustOptions& options);

// Standard deviations of the results of bundle adjustment.
struct Uncertainty {
  double pixel_sigma = 0;  // of the observations [px], by observed_pixel_sigma()
  // One vector for each camera, in the units of housing_change.h. The standard deviation of a
  // free number is infinite if the observations do not determine the number. Numbers that are not
  // free have 0.
  std::vector<HousingChange<double>> camera_sigmas;
  // The relative standard deviation of the scale. It is computed for one length: the distance
  // between the first image with observations and the observed image farthest from it. Infinite
  // if nothing determines the scale, for example for cameras in air. 0 if poses are known.
  double scale_sigma = 0;
};

// First-order standard deviations of the result of adjust(), from the normal equations with the
// points eliminated. Precondition: adjust() was called for `bundle` with the same `options`. The
// observations are weighted with their observed standard deviation and not with
// `options.pixel_sigma`.
Uncertainty uncertainty(const Bundle& bundle, const AdjustOptions& options);

}  // namespace axial::pose
