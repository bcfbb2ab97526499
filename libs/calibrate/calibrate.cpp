// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/calibrate.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "calibrate/board_pose.h"
#include "calibrate/board_turn.h"

namespace axial::calibrate {
namespace {

constexpr std::size_t kMinCorners = 8;  // of a photograph
constexpr std::size_t kMinViews = 3;    // photographs

// Error if fewer than the necessary photographs show the board. The message gives one example of
// `left_out`.
void require_views(std::size_t count, std::span<const LeftOut> left_out) {
  if (count >= kMinViews) return;
  std::string said = fmt::format(
      "{} photographs show {} or more corners of the board, at least {} are needed; 20 are better, "
      "with the board near each edge of the image, tilted, near and far",
      count, kMinCorners, kMinViews);
  if (!left_out.empty())
    said += fmt::format("; {}: {}", left_out.front().image, left_out.front().reason);
  throw Error(said);
}

// Error if fewer than the necessary photographs are left. `what`: the verb phrase of the message.
void require_fitting(std::size_t count, std::size_t of, const std::string& what) {
  if (count < kMinViews)
    fail(
        "only {} of {} photographs {}, at least {} are needed: check the board, the lens "
        "calibrated in air and the kind of port",
        count, of, what, kMinViews);
}

// Wrong pieces have many corners that do not fit, or larger errors than other photographs.
std::vector<bool> wrong_pieces(const pose::Bundle& bundle, std::span<const View> views) {
  constexpr double kLeastFitting = 0.75, kMostTimesMedian = 4;
  constexpr double kGood = 0.5;  // [px]: never wrong
  std::vector<double> rms, sorted;
  const auto errors = reprojection_errors_by_image(bundle);
  for (const std::vector<double>& of_image : errors) {
    rms.push_back(pose::root_mean_square(of_image));
    if (!of_image.empty()) sorted.push_back(rms.back());
  }
  std::ranges::sort(sorted);
  std::vector<bool> wrong(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto fitting = static_cast<double>(errors[i].size());
    const auto all = static_cast<double>(views[i].corners.size());
    wrong[i] = views[i].piece && fitting > 0 &&
               (fitting < kLeastFitting * all ||
                rms[i] > std::max(kGood, kMostTimesMedian * sorted[sorted.size() / 2]));
  }
  return wrong;
}

// Drops corners with larger errors, then all corners of photographs with too few left and of wrong
// pieces.
void drop_misfits(pose::Bundle& bundle, std::span<const View> views, double max_error) {
  const std::vector<double> errors = reprojection_errors(bundle);
  std::vector<pose::Observation> believed;
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (errors[i] <= max_error) believed.push_back(bundle.observations[i]);
  bundle.observations = std::move(believed);
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  const std::vector<bool> wrong = wrong_pieces(bundle, views);
  std::erase_if(bundle.observations, [&](const pose::Observation& observation) {
    return counts[observation.image] < kMinCorners || wrong[observation.image];
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
    drop_misfits(bundle, calibration.views, lenience * options.max_error);
    if (bundle.observations.empty()) return;
    adjusting.loss_sigmas = options.adjust.loss_sigmas;
    adjusting.pixel_sigma = observed_pixel_sigma(bundle, adjusting);
  }
  calibration.last = adjust(bundle, adjusting);
}

// Removes images without observations. `reason`: why a whole board has none.
void leave_out_unobserved(Calibration& calibration, const std::string& reason) {
  pose::Bundle& bundle = calibration.bundle.bundle;
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  std::vector<std::size_t> place(counts.size());
  std::vector<View> views;
  std::vector<pose::BundleImage> images;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    place[i] = images.size();
    if (counts[i] == 0) {
      const View& view = calibration.views[i];
      calibration.left_out.push_back(
          {view.image, view.piece ? "its corners are not a regular piece of the board" : reason});
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

std::string why_too_few(const View& view) {
  if (!view.fault.empty()) return view.fault;
  return fmt::format("{} corners of the board are found, at least {} are needed",
                     view.corners.size(), kMinCorners);
}

// calibrate() with the numbers of corners in View::corners.
Calibration calibrate_numbered(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                               std::span<const View> views,
                               std::span<const Eigen::Vector3d> corners,
                               const CalibrateOptions& options) {
  Calibration calibration;
  for (const View& view : views) {
    if (view.corners.size() >= kMinCorners)
      calibration.views.push_back(view);
    else
      calibration.left_out.push_back({view.image, why_too_few(view)});
  }
  require_views(calibration.views.size(), calibration.left_out);
  calibration.bundle = board_bundle(lens, port, calibration.views, corners);
  const std::size_t shown = calibration.views.size();
  place_boards(calibration.bundle.bundle);
  leave_out_unobserved(calibration, "the corners do not determine the pose of the board");
  require_fitting(calibration.views.size(), shown, "determine the pose of the board");
  adjust_in_rounds(calibration, options);
  leave_out_unobserved(calibration, "too few corners fit one pose of the board");
  require_fitting(calibration.views.size(), shown,
                  fmt::format("have {} or more corners that fit", kMinCorners));
  calibration.uncertainty = uncertainty(calibration.bundle.bundle, calibration.adjust);
  return calibration;
}

}  // namespace

std::size_t Calibration::pieces() const {
  return static_cast<std::size_t>(std::ranges::count(views, true, &View::piece));
}

Calibration calibrate(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                      std::span<const View> views, std::span<const Eigen::Vector3d> corners,
                      const CalibrateOptions& options) {
  std::vector<View> numbered(views.begin(), views.end());
  choose_turns(lens, port, numbered, corners);
  constexpr int kMostChoices = 4;
  for (int choice = 1;; ++choice) {
    Calibration calibration = calibrate_numbered(lens, port, numbered, corners, options);
    if (choice == kMostChoices ||
        !choose_turns(lens, *calibration.camera().now().port, numbered, corners))
      return calibration;
  }
}

}  // namespace axial::calibrate
