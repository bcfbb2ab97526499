// SPDX-License-Identifier: GPL-3.0-or-later
// Refractive bundle adjustment.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pose/bundle.h"

namespace axial::pose {

// The known length [m] between two images, by their indices, or two points, by their sources.
struct KnownDistance {
  enum class Between { images, points } between = Between::images;
  std::size_t first = 0, second = 0;
  double metres = 0;
  double sigma = 0;  // [m], above 0
};

// Where a camera centre is known to be.
struct KnownPosition {
  std::size_t image = 0;
  Eigen::Vector3d metres = Eigen::Vector3d::Zero();
  double sigma = 0;  // [m], above 0
};

// Which of a camera's numbers are unknown (housing_change.h), and how well each was measured [its
// own unit]; 0: nothing is known.
struct Unknowns {
  std::array<bool, kHousingNumbers> free{};
  std::array<double, kHousingNumbers> prior_sigma{};
};

struct AdjustOptions : Unknowns {  // those of all cameras
  // Those of domes, where they are not those of all: a flat port's first numbers are others.
  std::optional<Unknowns> of_domes;

  const Unknowns& unknowns(const BundleCamera& camera) const;

  std::vector<KnownDistance> distances;
  std::vector<KnownPosition> positions;  // three or more also hold the model in place
  bool points_known = false;             // they stay where they are, and hold the model in place
  bool poses_known = false;              // the same of the images

  double pixel_sigma = 1;  // of the observations [px]: weighs them against what is known
  double loss_sigmas = 2;  // errors beyond count linearly (Huber)
  int max_iterations = 100;
};

struct AdjustReport {
  bool converged = false;
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;  // halves of sums, [pixel_sigma^2]
};

// Moves poses, points and the free numbers to where the observations' errors are least. The first
// image with observations stays where it is unless known positions, points or poses hold the model.
// One thread: the sums of several would depend on which comes first. Error for a free number that
// the cameras' ports do not have, a length or sigma that is not positive, a bundle without
// observations.
AdjustReport adjust(Bundle& bundle, const AdjustOptions& options);

// Standard deviation of the observations [px] that their errors tell: every unknown takes the noise
// of one residual away.
double observed_pixel_sigma(const Bundle& bundle, const AdjustOptions& options);

// How well the adjusted bundle knows what it does not directly see.
struct Uncertainty {
  double pixel_sigma = 0;  // of the observations, from their residuals
  // Of the free numbers, infinite where nothing tells them; 0 for the others.
  std::vector<HousingChange<double>> camera_sigmas;
  // Of the scale, relative: of the distance from the first image to the one farthest from it.
  // Infinite where nothing tells it, as for cameras in air; 0 where poses are known.
  double scale_sigma = 0;
};

// First-order standard deviations from the normal equations at the solution, points eliminated.
Uncertainty uncertainty(const Bundle& bundle, const AdjustOptions& options);

}  // namespace axial::pose
