// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/control/control_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pose/adjust/adjust.h"
#include "pose/adjust/uncertainty.h"
#include "pose/bundle/free_motions.h"
#include "pose/bundle/known.h"
#include "pose/bundle/rig_fit.h"
#include "scene/decompositions.h"
#include "scene/robust_similarity.h"

namespace axial::pose {
namespace {

using Between = KnownDistance::Between;

constexpr double kWrong = 4;           // standard deviations
constexpr double kLeastControl = 0.1;  // of the variance that the other numbers must explain
constexpr double kOtherScale =
    0.3;                      // of lengths at the start, when poses are those of a pinhole engine
constexpr double kHuber = 3;  // adjust() counts larger deviations linearly

// The places of all ends, each once, and the covariance of their coordinates.
class Covariances {
 public:
  Covariances(const Bundle& bundle, const AdjustOptions& options,
              std::span<const KnownDistance> distances, std::span<const KnownPlace> places) {
    for (const KnownDistance& known : distances)
      for (const std::size_t end : {known.first, known.second}) add({known.between, end});
    for (const KnownPlace& known : places) add({known.of, known.index});
    if (!indices_.empty()) covariance_ = covariance_of_places(bundle, options, indices_);
  }

  double of_coordinate(const KnownPlace& known, int axis) const {
    const Eigen::Index row = row_of({known.of, known.index}) + axis;
    return covariance_(row, row);
  }

  // `direction`: unit, from the second to the first end.
  double of_length(const KnownDistance& known, const Eigen::Vector3d& direction) const {
    const Eigen::Index a = row_of({known.between, known.first});
    const Eigen::Index b = row_of({known.between, known.second});
    const Eigen::Matrix3d sum = covariance_.block<3, 3>(a, a) + covariance_.block<3, 3>(b, b) -
                                covariance_.block<3, 3>(a, b) - covariance_.block<3, 3>(b, a);
    const double variance = direction.dot(sum * direction);
    return std::isfinite(variance) ? std::max(0.0, variance)
                                   : std::numeric_limits<double>::infinity();
  }

 private:
  void add(const PlaceIndex& place) {
    if (std::ranges::find(indices_, place) == indices_.end()) indices_.push_back(place);
  }
  Eigen::Index row_of(const PlaceIndex& place) const {
    return 3 * (std::ranges::find(indices_, place) - indices_.begin());
  }

  std::vector<PlaceIndex> indices_;
  Eigen::MatrixXd covariance_;
};

// The weight that the loss gives to a known value, from its difference.
double weight_of(double known_sigma, double off) {
  return std::min(1.0, kHuber * known_sigma / std::abs(off));
}

// `variance`: of the present value.
KnownFit fit_of(double known, double known_sigma, double present, double variance, bool used) {
  KnownFit fit{known, present, known_sigma, std::sqrt(variance), known_sigma};
  if (!std::isfinite(known_sigma)) return fit;
  const double own = known_sigma * known_sigma;
  if (!used) {
    fit.expected = std::sqrt(own + variance);
    return fit;
  }
  const double weight = weight_of(known_sigma, fit.off());
  constexpr double kLeast = 1.0 / 25;
  fit.expected = std::sqrt(std::max(kLeast * own, own - weight * variance));
  return fit;
}

KnownFit fit_of(const Bundle& bundle, const KnownDistance& known, const Covariances& covariances,
                bool used) {
  const Eigen::Vector3d between =
      place_in(bundle, known.between, known.first) - place_in(bundle, known.between, known.second);
  return fit_of(known.metres, known.sigma, between.norm(),
                covariances.of_length(known, between.normalized()), used);
}

// Whether motions of the model that no used coordinate determines change a coordinate of a place.
bool is_free(const std::vector<Motion>& motions, const Eigen::Vector3d& place, int axis) {
  constexpr double kNoChange = 1e-3;  // of the motion
  return std::ranges::any_of(motions, [&](const Motion& motion) {
    return std::abs(motion.shift_of(place)(axis)) > kNoChange;
  });
}

PlaceFit fit_of(const Bundle& bundle, const KnownPlace& known, const Covariances& covariances,
                const std::vector<Motion>& free, bool used) {
  PlaceFit fit;
  const Eigen::Vector3d place = place_in(bundle, known.of, known.index);
  for (int k = 0; k < 3; ++k)
    fit.coordinates[static_cast<std::size_t>(k)] = fit_of(
        known.metres(k), known.sigma(k), place(k), covariances.of_coordinate(known, k), used);
  for (int k = 0; k < 3; ++k)
    if (!used && is_free(free, place, k))
      fit.coordinates[static_cast<std::size_t>(k)].expected =
          std::numeric_limits<double>::infinity();
  return fit;
}

// The part of a used value that other values control, so that an error of it shows: from 0, none,
// to 1.
double control_of(const KnownFit& fit) {
  if (!std::isfinite(fit.known_sigma)) return 0;
  return 1 -
         weight_of(fit.known_sigma, fit.off()) * std::pow(fit.present_sigma / fit.known_sigma, 2);
}

// The coordinate of a place with the largest deviation.
const KnownFit& worst_of(const PlaceFit& fit) {
  return *std::ranges::max_element(fit.coordinates, {}, [](const KnownFit& one) {
    return std::isfinite(one.known_sigma) ? std::abs(one.deviation()) : -1.0;
  });
}

std::string in_millimetres(double metres) {
  return fmt::format("{:.3g} mm", 1000 * std::abs(metres));
}

// The ratio of a length to its right value in words.
std::string unit_hint(double ratio) {
  constexpr double kFoot = 0.3048, kClose = 0.05;
  if (std::abs(ratio * kFoot - 1) < kClose) return "which say that it is in feet";
  return fmt::format("from which it differs by a factor of {:.3g}", ratio);
}

std::string line_of(const KnownDistance& known, const KnownFit& fit) {
  return fmt::format("{} is {} {} than stated ({:.4g} m), {:.2g} standard deviations", known.name,
                     in_millimetres(fit.off_from_others()), fit.off() > 0 ? "longer" : "shorter",
                     fit.known, std::abs(fit.deviation()));
}

std::string line_of(const KnownPlace& known, const PlaceFit& fit) {
  const KnownFit& worst = worst_of(fit);
  const auto axis = &worst - fit.coordinates.data();
  return fmt::format("{} is {} from its stated {}, {:.2g} standard deviations", known.name,
                     in_millimetres(worst.off_from_others()),
                     std::string("xyz")[static_cast<std::size_t>(axis)],
                     std::abs(worst.deviation()));
}

// A length or place, and how it fits.
struct Suspect {
  double deviation = 0;
  std::size_t index = 0;  // into distances or places
  bool is_place = false;
  double control = 0;  // control_of()
  std::string name, line;
};

bool has_named(const AdjustOptions& options) {
  return !options.places.empty() ||
         std::ranges::any_of(options.distances,
                             [](const KnownDistance& known) { return !known.name.empty(); });
}

// The known values of which some may be left out, the largest deviation first.
std::vector<Suspect> suspects(const Bundle& bundle, const AdjustOptions& options) {
  if (options.points_known || options.poses_known || !has_named(options)) return {};
  const ControlFits fits = control_fits(bundle, options, options.distances, options.places, true);
  std::vector<Suspect> found;
  for (std::size_t i = 0; i < fits.distances.size(); ++i)
    if (const KnownFit& fit = fits.distances[i]; !options.distances[i].name.empty())
      found.push_back({std::abs(fit.deviation()), i, false, control_of(fit),
                       options.distances[i].name, line_of(options.distances[i], fit)});
  for (std::size_t i = 0; i < fits.places.size(); ++i) {
    const KnownFit& worst = worst_of(fits.places[i]);
    found.push_back({std::abs(worst.deviation()), i, true, control_of(worst),
                     options.places[i].name, line_of(options.places[i], fits.places[i])});
  }
  std::ranges::stable_sort(found, std::greater{}, &Suspect::deviation);
  return found;
}

// Whether other values show that a value is wrong.
bool is_wrong(const Suspect& one) {
  return one.deviation > kWrong && one.control > kLeastControl;
}

AdjustOptions without(AdjustOptions options, const Suspect& one) {
  const auto index = static_cast<std::ptrdiff_t>(one.index);
  if (one.is_place)
    options.places.erase(options.places.begin() + index);
  else
    options.distances.erase(options.distances.begin() + index);
  return options;
}

// The lengths and places among `before` that nothing controls any more with `options`, which lacks
// one of `before`.
std::vector<Suspect> uncontrolled_now(std::span<const Suspect> before, const AdjustOptions& options,
                                      const Bundle& bundle) {
  constexpr double kRounding = 1e-3;
  std::vector<Suspect> found;
  for (const Suspect& now : suspects(bundle, options)) {
    if (now.control > kLeastControl) continue;
    const auto same = std::ranges::find(before, now.name, &Suspect::name);
    // What was not controlled before, either, has lost nothing.
    if (same != before.end() && same->control > 2 * std::max(now.control, kRounding))
      found.push_back(*same);
  }
  return found;
}

// The bundle, adjusted without a value.
struct Trial {
  Suspect one;
  AdjustOptions options;  // without `one`
  Bundle bundle;
  double cost = 0;  // half of it
};

Trial trial_without(const Suspect& one, const Bundle& bundle, const AdjustOptions& options,
                    const Context& context) {
  Trial trial{one, without(options, one), bundle};
  AdjustOptions adjusting = trial.options;
  adjusting.starts_close = true;
  context.info("Adjusts without {}, which may be wrong", one.name);
  try {
    trial.cost = adjust(trial.bundle, adjusting, {}, context).final_cost;
  } catch (const Error&) {
    trial.cost = std::numeric_limits<double>::infinity();  // the others need this value
  }
  return trial;
}

// The value without which the others agree best, and a value that explains the deviations nearly as
// well, if there is one.
struct Verdict {
  Trial best;
  std::optional<Suspect> rival;
};

constexpr std::size_t kMostTrials = 4;

// Compares the best trial with those of the values that only its value controls.
void judge_rivals(Verdict& verdict, std::span<const Suspect> found, const Bundle& bundle,
                  const AdjustOptions& options, const Context& context) {
  constexpr double kClear = kWrong * kWrong / 2;  // of half the cost
  std::vector<Suspect> rivals = uncontrolled_now(found, verdict.best.options, bundle);
  rivals.resize(std::min(rivals.size(), kMostTrials));
  const double cost = verdict.best.cost;
  for (const Suspect& rival : rivals) {
    Trial trial = trial_without(rival, bundle, options, context);
    if (trial.cost > cost + kClear) continue;
    if (trial.cost >= cost - kClear)
      verdict.rival = rival;
    else if (trial.cost < verdict.best.cost)
      verdict = {std::move(trial), {}};
  }
}

// Which value is wrong; nothing if none deviates. `found`: the suspects. The largest deviation need
// not be that of the wrong value: a wrong value that few others control draws them to itself.
std::optional<Verdict> verdict_on(std::span<const Suspect> found, const Bundle& bundle,
                                  const AdjustOptions& options, const Context& context) {
  std::optional<Verdict> verdict;
  std::size_t trials = 0;
  for (const Suspect& one : found) {
    if (!is_wrong(one) || trials++ >= kMostTrials) continue;
    Trial trial = trial_without(one, bundle, options, context);
    if (!verdict || trial.cost < verdict->best.cost) verdict = Verdict{std::move(trial), {}};
  }
  if (!verdict || !std::isfinite(verdict->best.cost)) return {};
  judge_rivals(*verdict, found, bundle, options, context);
  return verdict;
}

// Which value is wrong besides the two that contradict each other: it deviates without the best of
// them, too.
std::optional<Verdict> verdict_besides(const Verdict& pair, const Context& context) {
  std::vector<Suspect> found = suspects(pair.best.bundle, pair.best.options);
  std::erase_if(found, [&](const Suspect& one) { return one.name == pair.rival->name; });
  return verdict_on(found, pair.best.bundle, pair.best.options, context);
}

// Removes lengths with another scale than most.
void leave_out_other_scales(const Bundle& bundle, AdjustOptions& options,
                            std::vector<std::string>& lines) {
  std::vector<double> scales;
  const auto scale_of = [&](const KnownDistance& known) {
    return known.metres / (place_in(bundle, known.between, known.first) -
                           place_in(bundle, known.between, known.second))
                              .norm();
  };
  for (const KnownDistance& known : options.distances)
    if (const double scale = scale_of(known); std::isfinite(scale)) scales.push_back(scale);
  if (scales.size() < 2) return;
  std::ranges::sort(scales);
  // Two lengths that contradict each other are both far from their mean.
  const double usual =
      scales.size() == 2 ? std::sqrt(scales[0] * scales[1]) : scales[scales.size() / 2];
  const double limit = scales.size() == 2 ? kOtherScale / 2 : kOtherScale;
  std::erase_if(options.distances, [&](const KnownDistance& known) {
    const double scale = scale_of(known);
    if (known.name.empty() || !std::isfinite(scale) ||
        std::abs(std::log(scale / usual)) <= std::log1p(limit))
      return false;
    lines.push_back(fmt::format("{} is left out: {:.4g} m do not fit the other lengths, {}",
                                known.name, known.metres, unit_hint(scale / usual)));
    return true;
  });
}

// Why a place cannot be used; nothing if it can. A point without observations stays in a bundle
// until filter().
std::optional<std::string> why_lost(const Bundle& bundle, const PlaceIndex& place) {
  if (place.of == Between::images) {
    if (observations_by_image(bundle)[place.index] > 0) return {};
    return "the photograph is left out";
  }
  const bool seen = std::ranges::any_of(bundle.observations, [&](const Observation& one) {
    return bundle.points[one.point].source == place.index;
  });
  if (seen) return {};
  return "fewer than two photographs that fit show the target";
}

}  // namespace

ControlFits control_fits(const Bundle& bundle, const AdjustOptions& options,
                         std::span<const KnownDistance> distances,
                         std::span<const KnownPlace> places, bool used) {
  const Covariances covariances(bundle, options, distances, places);
  ControlFits fits;
  for (const KnownDistance& known : distances)
    fits.distances.push_back(fit_of(bundle, known, covariances, used));
  const std::vector<Motion> free =
      used || options.poses_known ? std::vector<Motion>() : free_motions(bundle, options);
  for (const KnownPlace& known : places)
    fits.places.push_back(fit_of(bundle, known, covariances, free, used));
  return fits;
}

std::vector<std::string> leave_out_lost(const Bundle& bundle, AdjustOptions& options) {
  std::vector<std::string> lines;
  std::erase_if(options.distances, [&](const KnownDistance& known) {
    if (known.name.empty()) return false;
    for (const std::size_t end : {known.first, known.second})
      if (const auto why = why_lost(bundle, {known.between, end})) {
        lines.push_back(fmt::format("{} is not used: {}", known.name, *why));
        return true;
      }
    return false;
  });
  std::erase_if(options.places, [&](const KnownPlace& known) {
    const auto why = why_lost(bundle, {known.of, known.index});
    if (why) lines.push_back(fmt::format("{} is not used: {}", known.name, *why));
    return why.has_value();
  });
  return lines;
}

std::vector<std::string> leave_out_outliers(const Bundle& bundle, AdjustOptions& options) {
  std::vector<std::string> lines;
  leave_out_other_scales(bundle, options, lines);
  std::vector<std::size_t> whole;
  for (std::size_t i = 0; i < options.places.size(); ++i)
    if (options.places[i].knows_all()) whole.push_back(i);
  const auto count = static_cast<Eigen::Index>(whole.size());
  Eigen::Matrix3Xd present(3, count), known(3, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const KnownPlace& place = options.places[whole[static_cast<std::size_t>(k)]];
    present.col(k) = place_in(bundle, place.of, place.index);
    known.col(k) = place.metres;
  }
  if (count < 4 || relative_width(present) < kLineWidth) return lines;
  const RobustSimilarity fit = robust_similarity(present, known);
  for (const std::size_t k : fit.outliers) {
    const KnownPlace& place = options.places[whole[k]];
    std::string line = fmt::format("{} is left out: it is {} from its stated place", place.name,
                                   in_millimetres(fit.distances[k]));
    for (const std::size_t other : fit.outliers) {
      const Eigen::Vector3d moved = fit.similarity(present.col(static_cast<Eigen::Index>(k)));
      const double apart = (moved - known.col(static_cast<Eigen::Index>(other))).norm();
      if (other != k && apart < 0.1 * fit.distances[k])
        line += fmt::format("; it is at the stated place of {}: the labels seem to be exchanged",
                            options.places[whole[other]].name);
    }
    lines.push_back(std::move(line));
  }
  for (std::size_t k = fit.outliers.size(); k-- > 0;)
    options.places.erase(options.places.begin() +
                         static_cast<std::ptrdiff_t>(whole[fit.outliers[k]]));
  return lines;
}

bool leave_out_worst(const Bundle& bundle, AdjustOptions& options, std::vector<std::string>& lines,
                     const Context& context) {
  const std::vector<Suspect> found = suspects(bundle, options);
  std::optional<Verdict> verdict = verdict_on(found, bundle, options, context);
  if (verdict && verdict->rival) verdict = verdict_besides(*verdict, context);
  if (!verdict || verdict->rival) return false;
  const auto wrong = std::ranges::find(found, verdict->best.one.name, &Suspect::name);
  lines.push_back(wrong->line + "; it is left out");
  options = without(std::move(options), *wrong);
  return true;
}

std::vector<std::string> contradictions(const Bundle& bundle, const AdjustOptions& options,
                                        const Context& context) {
  std::vector<std::string> lines;
  std::optional<Verdict> verdict = verdict_on(suspects(bundle, options), bundle, options, context);
  while (verdict && verdict->rival) {
    lines.push_back(fmt::format("{}; {}: the two contradict each other, and both are kept",
                                verdict->best.one.line, verdict->rival->line));
    verdict = verdict_besides(*verdict, context);
  }
  return lines;
}

}  // namespace axial::pose
