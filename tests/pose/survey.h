// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated survey with known poses and points. Its cameras are pinholes behind any port. The
// tracks are exact up to a given noise.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "pose/bundle/adjust_options.h"

namespace axial::pose::testing {

inline constexpr double kDegree = std::numbers::pi / 180;

inline refractive::FlatPort<double> flat_port(double tilt_degrees = 0, double distance = 0.02) {
  const double tilt = tilt_degrees * kDegree;
  return {{std::sin(tilt), 0, std::cos(tilt)}, distance, 0.014, 1, 1.52, 1.333};
}

inline refractive::DomePort<double> dome_port() {
  return {{0.003, -0.004, 0.002}, 0.05, 0.007, 1, 1.52, 1.333};
}

inline CameraModel camera_behind(std::optional<refractive::Port<double>> port) {
  return {1024, 768, {610, 615, 511.5, 383.5}, std::move(port)};
}

// `camera`, a pinhole without distortion, in the form that bundle adjustment needs.
inline HousedCamera housed(const CameraModel& camera) {
  return {{lens::find_model("PINHOLE"), camera.lens, {}, camera.width, camera.height}, camera.port};
}

// A camera at `centre` that looks at `target`, rotated about its axis by `roll` [rad].
Pose looking_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& target, double roll);

struct SurveyOptions {
  double distance = 0.8;  // from the cameras to the ground [m]
  int images = 12;
  int points = 300;
  double noise = 0;  // standard deviation per axis [px]
  unsigned seed = 1;
};

// Returns a survey of rough ground by tilted cameras that are rotated about their axes.
Bundle survey(const CameraModel& camera, const SurveyOptions& options);

// Like survey(), but the images are taken by the cameras `first` and `second` in turn.
Bundle mixed_survey(const CameraModel& first, const CameraModel& second,
                    const SurveyOptions& options);

// The survey as a pinhole engine with a free focal length reconstructs it: with poses and points
// that absorbed refraction, at `scale` times the true lengths. The cameras are those of `truth`.
Bundle absorbed(const Bundle& truth, double scale);

// The true length between the first and the last image. Its standard deviation is `sigma` times as
// long.
KnownDistance known_length(const Bundle& truth, double sigma = 1e-4);

// Moves poses and points at random. The standard deviations are `angle` [rad] for rotations, and
// `shift` [m] for positions.
void disturb(Bundle& bundle, double angle, double shift, unsigned seed);

// Errors of centres and rotations after the best similarity to the truth.
struct PoseErrors {
  double centre_rms = 0;     // [m]
  double largest_angle = 0;  // [degrees]
  double scale = 1;          // of the best similarity
};

PoseErrors pose_errors(const Bundle& found, const Bundle& truth, bool with_scale = true);

}  // namespace axial::pose::testing
