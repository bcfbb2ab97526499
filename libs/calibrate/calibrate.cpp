// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/calibrate.h"

#include <fmt/format.h>

#include "base/error.h"
#include "calibrate/board_pose.h"

namespace axial::calibrate {
namespace {

constexpr std::size_t kMinCorners = 8;  // of a photograph
constexpr std::size_t kMinViews = 3;    // photographs

void require_views(std::size_t count) {
  if (count < kMinViews)
    fail(
        "{} photographs show {} or more corners of the board, at least {} are needed; 20 are "
        "better, with the board near each edge of the image, tilted, near and far",
        count, kMinCorners, kMinViews);
}

// Error if fewer than the necessary photographs are left. `what`: the verb phrase of the message.
void require_fitting(std::size_t count, std::size_t of, const std::string& what) {
  if (count < kMinViews)
    fail(
        "only {} of {} photographs {}, at least {} are needed: check the board, the lens "
        "calibrated in air and the kind of port",
        count, of, what, kMinViews);
}

// Drops corners with larger errors, then all corners of photographs with too few left.
void drop_misfits(pose::Bundle& bundle, double max_error) {
  const std::vector<double> errors = reprojection_errors(bundle);
  std::vector<pose::Observation> believed;
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (errors[i] <= max_error) believed.push_back(bundle.observations[i]);
  bundle.observations = std::move(believed);
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  std::erase_if(bundle.observations, [&](const pose::Observation& observation) {
    return counts[observation.image] < kMinCorners;
  });
}

// Adjusts the port and the board poses in rounds, and drops corners that do not fit.
void adjust_in_rounds(Calibration& calibration, const CalibrateOptions& options) {
  pose::Bundle& bundle = calibration.bundle.bundle;
  pose::AdjustOptions& adjusting = calibration.adjust;
  adjusting = options.adjust;
  adjusting.points_known = true;
  adjusting.loss_sigmas *= 4;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    // Wider limits at first: errors caused by a wrong port do not mark outliers.
    const double lenience = round == 0 ? 4 : 1;
    adjust(bundle, adjusting);
    drop_misfits(bundle, lenience * options.max_error);
    if (bundle.observations.empty()) return;
    adjusting.loss_sigmas = options.adjust.loss_sigmas;
    adjusting.pixel_sigma = observed_pixel_sigma(bundle, adjusting);
  }
  calibration.last = adjust(bundle, adjusting);
}

// Removes images without observations.
void leave_out_unobserved(Calibration& calibration) {
  pose::Bundle& bundle = calibration.bundle.bundle;
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  std::vector<std::size_t> place(counts.size());
  std::vector<View> views;
  std::vector<pose::BundleImage> images;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    place[i] = images.size();
    if (counts[i] == 0) {
      calibration.left_out.push_back(calibration.views[i].image);
      continue;
    }
    images.push_back(bundle.images[i]);
    views.push_back(std::move(calibration.views[i]));
  }
  for (pose::Observation& observation : bundle.observations)
    observation.image = place[observation.image];
  bundle.images = std::move(images);
  calibration.views = std::move(views);
}

}  // namespace

Calibration calibrate(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                      std::span<const View> views, std::span<const Eigen::Vector3d> corners,
                      const CalibrateOptions& options) {
  Calibration calibration;
  for (const View& view : views) {
    if (view.corners.size() >= kMinCorners)
      calibration.views.push_back(view);
    else
      calibration.left_out.push_back(view.image);
  }
  require_views(calibration.views.size());
  calibration.bundle = board_bundle(lens, port, calibration.views, corners);
  const std::size_t shown = calibration.views.size();
  place_boards(calibration.bundle.bundle);
  leave_out_unobserved(calibration);
  require_fitting(calibration.views.size(), shown, "determine the pose of the board");
  adjust_in_rounds(calibration, options);
  leave_out_unobserved(calibration);
  require_fitting(calibration.views.size(), shown,
                  fmt::format("have {} or more corners that fit", kMinCorners));
  calibration.uncertainty = uncertainty(calibration.bundle.bundle, calibration.adjust);
  return calibration;
}

}  // namespace axial::calibrate
