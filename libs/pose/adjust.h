// SPDX-License-Identifier: GPL-3.0-or-later
// Refractive bundle adjustment.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pose/bundle.h"

namespace axial::pose {

// A known length between two camera centres (`first` and `second` are indices of images) or between
// two points (they are sources of points, BundlePoint::source).
struct KnownDistance {
  enum class Between { images, points } between = Between::images;
  std::size_t first = 0, second = 0;  // indices of images, or sources of points
  double metres = 0;                  // [m], above 0
  double sigma = 0;                   // [m], above 0
};

// A known camera centre.
struct KnownPosition {
  std::size_t image = 0;
  Eigen::Vector3d metres = Eigen::Vector3d::Zero();  // [m], world frame
  double sigma = 0;                                  // [m], above 0
};

// Which numbers of a camera (housing_change.h) are unknown, and the standard deviation with which
// each of them was measured, in the unit of that number. A standard deviation of 0 means that the
// number was not measured.
struct Unknowns {
  std::array<bool, kHousingNumbers> free{};
  std::array<double, kHousingNumbers> prior_sigma{};
};

struct AdjustOptions : Unknowns {  // for all cameras
  // The unknowns of cameras behind domes, where they differ from the unknowns of all cameras: the
  // first three numbers of a dome and of a flat port have different meanings.
  std::optional<Unknowns> of_domes;

  // The unknowns that apply to `camera`.
  const Unknowns& unknowns(const BundleCamera& camera) const;

  std::vector<KnownDistance> distances;
  std::vector<KnownPosition> positions;  // three or more also fix the model's place
  bool points_known = false;             // points stay where they are and fix the model's place
  bool poses_known = false;              // poses stay where they are and fix the model's place

  double pixel_sigma = 1;  // [px] of the observations: weighs them against the known numbers
  double loss_sigmas = 2;  // Huber loss: larger errors [pixel_sigma] count linearly
  int max_iterations = 100;
};

struct AdjustReport {
  bool converged = false;
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;  // halves of the sums of squares [pixel_sigma^2]
};

// Refractive bundle adjustment: changes the poses, the points and the free numbers of the cameras
// so that the squared reprojection errors (exact projection, Huber loss) are least. The first image
// with observations stays where it is, unless three known positions, known points or known poses
// fix the model's place. Runs in one thread, because the sums of several threads would depend on
// their order. Error for a free number that a camera in air does not have, for a length or standard
// deviation that is not positive, for a bundle without observations, and if the solver fails.
AdjustReport adjust(Bundle& bundle, const AdjustOptions& options);

// Standard deviation of the observations [px], estimated from their reprojection errors: the sum of
// squares divided by the number of residuals minus the number of unknowns.
double observed_pixel_sigma(const Bundle& bundle, const AdjustOptions& options);

// Standard deviations of the results of bundle adjustment.
struct Uncertainty {
  double pixel_sigma = 0;  // [px] of the observations, from their residuals
  // Of the free numbers, one vector for each camera. Infinite where the observations do not
  // determine a number; 0 for numbers that are not free.
  std::vector<HousingChange<double>> camera_sigmas;
  // Relative standard deviation of the scale: of the distance from the first image with
  // observations to the image farthest from it. Infinite where nothing determines the scale, for
  // example for cameras in air; 0 where poses are known.
  double scale_sigma = 0;
};

// First-order standard deviations from the normal equations at the solution, with the points
// eliminated. `bundle` is adjusted with the same `options`.
Uncertainty uncertainty(const Bundle& bundle, const AdjustOptions& options);

}  // namespace axial::pose
