// SPDX-License-Identifier: GPL-3.0-or-later
// What refractive bundle adjustment knows and what it may change.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "pose/bundle/bundle.h"

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

}  // namespace axial::pose
