// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/refine.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

#include "base/error.h"
#include "base/order_statistics.h"
#include "pose/adjust/adjust.h"
#include "pose/adjust/kept_numbers.h"
#include "pose/adjust/uncertainty.h"
#include "pose/bundle/known.h"
#include "pose/bundle/observation_weights.h"
#include "pose/bundle/rig_fit.h"
#include "pose/control/control_fit.h"
#include "pose/control/control_start.h"
#include "scene/decompositions.h"

namespace axial::pose {
namespace {

// Half a standard deviation in one direction. The last adjustment removes what is left.
constexpr double kGainOfRounds = 0.1;
// In the rounds, positions of unknown accuracy count with their estimated standard deviation times
// this.
constexpr double kLooseness = 3;
constexpr int kMostOfDelays = 6;            // adjustments; each leaves at most half of an error
constexpr double kUsualDistance = 2;        // of a scene [m], until a scale is known
constexpr std::size_t kTrialPoints = 1500;  // enough to distinguish scales
// Median distances of the scene [m] that are tried: from close-ups to wide surveys.
constexpr std::array<double, 7> kTrialDistances{0.25, 0.5, 1, 2, 4, 8, 16};

// The factor that scales the known lengths to metres, the median of all; 0 if no length is known.
double known_scale(const Bundle& bundle, const AdjustOptions& options) {
  std::vector<double> scales;
  for (const KnownDistance& known : options.distances) {
    const double length = (place_in(bundle, known.between, known.first) -
                           place_in(bundle, known.between, known.second))
                              .norm();
    if (length > 0)
      scales.push_back(known.metres / length);
    else if (known.name.empty())
      fail("a known length of {} m is zero in the model", known.metres);
  }
  return scales.empty() ? 0 : upper_median(std::move(scales));
}

// Moves the bundle to its known positions by a similarity; false if fewer than three are known.
bool place_by_positions(Bundle& bundle, const std::vector<KnownPosition>& positions) {
  if (positions.size() < 3) return false;
  const auto [centres, places] = centres_and_positions(bundle, positions);
  move_places(bundle, best_similarity(centres, places));
  return true;
}

// The cost that remains after a short adjustment of `trial` at another scale.
double trial_cost(Bundle trial, double scale) {
  scale_places(trial, scale);
  triangulate(trial);
  AdjustOptions options;
  options.max_iterations = 12;
  options.loss_sigmas = 4;
  try {
    return adjust(trial, options).final_cost;
  } catch (const Error&) {
    return std::numeric_limits<double>::infinity();  // the adjustment fails: other scales are tried
  }
}

double best_scale(const Bundle& bundle) {
  const Bundle part = most_observed(bundle, kTrialPoints, 0, [](std::size_t) { return true; });
  const double distance = median_distance(part);
  double best = 1, least = std::numeric_limits<double>::infinity();
  for (const double metres : kTrialDistances) {
    const double cost = trial_cost(part, metres / distance);
    if (cost < least) least = cost, best = metres / distance;
  }
  return best;
}

// Adjusts bundles and tells the progress.
class Adjuster {
 public:
  explicit Adjuster(const Context& context) : context_(context) {}

  AdjustReport adjust(Bundle& bundle, const AdjustOptions& options, const std::string& title) {
    const bool is_long = !options.poses_known && bundle.images.size() >= options.many_images;
    if (is_long) say(start_line(bundle, title));
    const auto tell = [&](const AdjustIteration& iteration) {
      seconds_ = iteration.seconds;
      const std::string line = fmt::format("{}: iteration {}, cost {:.8g}, {:.1f} s", title,
                                           iteration.number, iteration.cost, iteration.seconds);
      // Small models do not fill the log.
      if (Clock::now() - last_ >= std::chrono::seconds(2))
        say(line);
      else
        context_.details("{}", line);
    };
    return pose::adjust(bundle, options, tell, context_);
  }

  void say(const std::string& line) {
    last_ = Clock::now();
    context_.info("{}", line);
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::string start_line(const Bundle& bundle, const std::string& title) const {
    std::string line = fmt::format("{}: starts with {} images and {} points", title,
                                   bundle.images.size(), bundle.points.size());
    if (seconds_ > 0) line += fmt::format(", about {:.1f} s for each iteration", seconds_);
    return line;
  }

  const Context& context_;
  Clock::time_point last_ = Clock::now();  // of a line that is no detail
  double seconds_ = 0;                     // time of the last iteration; 0: there was none
};

// Judges the known positions before an adjustment.
void judge(const Bundle& bundle, double factor, AdjustOptions& options, RefineReport& report) {
  for (std::string& line : judge_positions(bundle, factor, options.positions))
    report.wrong_positions.push_back(std::move(line));
  report.positions = options.positions;
}

// Removes the observations of targets that stand at two places.
void drop_double_targets(Bundle& bundle, std::span<const Target> targets, RefineReport& report) {
  constexpr double kLeastError = 8, kMedians = 4;  // [px]; poses are those of a pinhole engine
  const double max_error =
      std::max(kLeastError, kMedians * upper_median(reprojection_errors(bundle)));
  for (const DoubleTarget& found : double_targets(bundle, targets, max_error)) {
    const Target& target = targets[found.target];
    report.wrong_control.push_back(fmt::format(
        "{} is left out: {} photographs show it at one place, {} at another, {:.3g} m apart; two "
        "plates have this label, or the plate was moved",
        target.label, found.first, found.second, found.distance));
    std::erase_if(bundle.observations, [&](const Observation& one) {
      return bundle.points[one.point].is_target && bundle.points[one.point].source == target.source;
    });
  }
}

// Leaves out bars and places that cannot be used or do not fit.
void judge_control(const Bundle& bundle, AdjustOptions& options, RefineReport& report) {
  for (std::string& line : leave_out_lost(bundle, options))
    report.wrong_control.push_back(std::move(line));
  for (std::string& line : leave_out_outliers(bundle, options))
    report.wrong_control.push_back(std::move(line));
}

// Sets free numbers to their measured values and keeps them, if the observations do not contradict
// these values. Returns whether there are such numbers.
bool keep_stated_numbers(Bundle& bundle, AdjustOptions& options) {
  options.kept = numbers_to_keep(bundle, options);
  bool any = false;
  for (std::size_t camera = 0; camera < bundle.cameras.size(); ++camera)
    for (std::size_t k = 0; k < kHousingNumbers; ++k)
      if (options.keeps(camera, k)) {
        bundle.cameras[camera].change(static_cast<Eigen::Index>(k)) = 0;
        any = true;
      }
  return any;
}

}  // namespace

void scale_places(Bundle& bundle, double scale) {
  for (BundleImage& image : bundle.images) image.pose.centre *= scale;
  for (BundlePoint& point : bundle.points) point.position *= scale;
}

// Known lengths and places scale and place the model. The places of targets depend on the scale:
// each step improves both.
void scale_by_control(Bundle& bundle, const AdjustOptions& options) {
  constexpr int kSteps = 4;
  for (int step = 0; step < kSteps; ++step) {
    if (const double known = known_scale(bundle, options); known > 0) scale_places(bundle, known);
    place_by_control(bundle, options);
    triangulate(bundle);
  }
}

void bring_to_metres(Bundle& bundle, const AdjustOptions& options) {
  leave_out_unobserved(bundle);
  if (!options.poses_known && !place_by_positions(bundle, options.positions)) {
    if (has_targets(bundle)) {
      scale_places(bundle, kUsualDistance / median_distance(bundle));
      triangulate(bundle);
    }
    if (!options.know_lengths()) {
      const double by_rigs = scale_by_rigs(bundle);
      scale_places(bundle, by_rigs > 0 ? by_rigs : best_scale(bundle));
    }
    if (has_targets(bundle) || !options.places.empty())
      scale_by_control(bundle, options);
    else if (const double known = known_scale(bundle, options); known > 0)
      scale_places(bundle, known);
  }
  triangulate(bundle);
  start_rigs(bundle);
}

RefineReport refine(Bundle& bundle, const RefineOptions& options, const Context& context) {
  RefineReport report;
  report.observations_before = bundle.observations.size();
  report.points_before = bundle.points.size();
  AdjustOptions adjusting = options.adjust;
  report.rms_before = root_mean_square(reprojection_errors(bundle));
  report.lost = lost_knowledge(bundle, adjusting);
  if (!report.lost.empty()) return report;

  // Wider limits at first: errors of the pinhole engine's poses do not mark outliers.
  TrackLimits limits = options.tracks;
  limits.max_error *= 4;
  adjusting.loss_sigmas *= 4;
  adjusting.least_gain = std::max(adjusting.least_gain, kGainOfRounds);
  adjusting.gain_of_outliers = std::max(adjusting.gain_of_outliers, kGainOfRounds);
  Adjuster adjuster(context);
  if (!options.targets.empty()) drop_double_targets(bundle, options.targets, report);
  for (int round = 0; round < options.rounds; ++round) {
    judge(bundle, kLooseness, adjusting, report);
    judge_control(bundle, adjusting, report);
    report.last = adjuster.adjust(bundle, adjusting, fmt::format("round {}", round + 1));
    adjusting.starts_close = true;
    // The adjusted cameras predict which of several observations in one image is the right one.
    if (round == 0) report.repeated = drop_repeated(bundle);
    const std::size_t dropped = filter(bundle, limits, &report.dropped);
    if (bundle.observations.empty()) fail("no observation fits refractive cameras");
    leave_out_unobserved(bundle);
    if (round > 0) set_delays(bundle);
    report.lost = lost_knowledge(bundle, adjusting);
    if (!report.lost.empty()) return report;
    adjuster.say(fmt::format("round {}: {} iterations, RMS {:.3f} px, {} observations dropped",
                             round + 1, report.last.iterations,
                             root_mean_square(reprojection_errors(bundle)), dropped));
    limits = options.tracks;
    adjusting.loss_sigmas = options.adjust.loss_sigmas;
    weigh_by_size(bundle);
    if (options.weigh_by_radius) weigh_by_radius(bundle);
    correct_targets(bundle, options.targets);
    adjusting.pixel_sigma = observed_pixel_sigma(bundle, adjusting);
  }
  adjusting.least_gain = options.adjust.least_gain;
  adjusting.gain_of_outliers = options.adjust.gain_of_outliers;
  judge(bundle, 1, adjusting, report);
  judge_control(bundle, adjusting, report);
  report.last = adjuster.adjust(bundle, adjusting, "last adjustment");
  const auto leave_out_wrong = [&] {
    while (leave_out_worst(bundle, adjusting, report.wrong_control, context))
      report.last = adjuster.adjust(bundle, adjusting, "adjustment without a wrong bar or place");
  };
  for (int i = 0; i < kMostOfDelays && set_delays(bundle); ++i)
    report.last = adjuster.adjust(bundle, adjusting, "adjustment with delays of cameras");
  // A wrong bar moves the numbers of the port, so it goes before these are judged.
  leave_out_wrong();
  if (options.keep_stated && keep_stated_numbers(bundle, adjusting)) {
    report.last = adjuster.adjust(bundle, adjusting, "adjustment with stated numbers");
    leave_out_wrong();
  }
  filter(bundle, limits, &report.dropped);
  leave_out_unobserved(bundle);
  if (bundle.observations.empty()) fail("no observation fits refractive cameras");
  report.lost = lost_knowledge(bundle, adjusting);
  judge_control(bundle, adjusting, report);
  for (const auto& lines :
       {contradictions(bundle, adjusting, context), signs_of_a_mirror(bundle, adjusting)})
    report.wrong_control.insert(report.wrong_control.end(), lines.begin(), lines.end());
  report.distances = adjusting.distances;
  report.places = adjusting.places;
  report.position_distances = position_distances(bundle, report.positions);
  correct_contradicted(report.position_distances, report.positions);
  report.rms_after = root_mean_square(reprojection_errors(bundle));
  report.observations_after = bundle.observations.size();
  report.points_after = bundle.points.size();
  return report;
}

}  // namespace axial::pose
