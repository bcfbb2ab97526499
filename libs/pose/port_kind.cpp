// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/port_kind.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "pose/track_sample.h"
#include "pose/tracks.h"

namespace axial::pose {
namespace {

constexpr SampleLimits kLimits{600, 40, 40, 1};
constexpr std::size_t kFewestImages = 3, kFewestPoints = 20;
constexpr double kBetter = 0.95;       // times the error
constexpr double kLeastGain = 36;      // of the cost, in squared standard deviations
constexpr double kStrained = 4;        // standard deviations of a number
constexpr double kAlike = 0.98;        // times the error
constexpr double kFinestNoise = 0.05;  // [px]
constexpr double kGlass = 0.008;       // [m]

// The numbers that may change, with their standard deviations. `place`: of lengths [m].
Unknowns unknowns_of(PortKind kind, double place) {
  constexpr double kNormal = 3 * std::numbers::pi / 180, kIndex = 0.004, kFocal = 0.005;
  Unknowns unknowns;
  unknowns.prior_sigma[kFocalNumber] = kFocal;
  if (kind != PortKind::none) unknowns.prior_sigma[kIndexNumber] = kIndex;
  if (kind == PortKind::flat)
    std::ranges::copy(std::array{kNormal, kNormal, place}, unknowns.prior_sigma.begin());
  if (kind == PortKind::dome)
    std::ranges::copy(std::array{place, place, place}, unknowns.prior_sigma.begin());
  for (std::size_t k = 0; k < unknowns.free.size(); ++k)
    unknowns.free[k] = unknowns.prior_sigma[k] > 0;
  return unknowns;
}

// Holds the length from the first image to the image farthest from it.
std::vector<KnownDistance> held_length(const Bundle& part) {
  const auto length = [&](std::size_t i) {
    return (part.images[i].pose.centre - part.images[0].pose.centre).norm();
  };
  std::size_t farthest = 0;
  for (std::size_t i = 1; i < part.images.size(); ++i)
    if (length(i) > length(farthest)) farthest = i;
  if (!(length(farthest) > 0)) return {};
  return {{KnownDistance::Between::images, 0, farthest, length(farthest), 1e-4 * length(farthest)}};
}

// The largest change of a number, in its standard deviations.
double strain_of(const Bundle& bundle, const Unknowns& unknowns) {
  double strain = 0;
  for (const BundleCamera& camera : bundle.cameras)
    for (std::size_t k = 0; k < unknowns.free.size(); ++k)
      if (unknowns.free[k])
        strain = std::max(strain, std::abs(camera.change(static_cast<Eigen::Index>(k))) /
                                      unknowns.prior_sigma[k]);
  return strain;
}

// A kind of port in a bundle that is being fitted.
struct KindTrial {
  PortKind kind = PortKind::none;
  Bundle bundle;
  AdjustOptions options;
  double cost = 0;  // half the cost of adjust(); infinite if it failed
};

void fit(KindTrial& trial) {
  try {
    trial.cost = adjust(trial.bundle, trial.options).final_cost;
  } catch (const Error&) {
    trial.cost = std::numeric_limits<double>::infinity();
  }
}

KindTrial first_fit(PortKind kind, const Bundle& part, bool is_stated,
                    const AdjustOptions& options) {
  constexpr double kMeasured = 0.005;                           // [m]
  const double guessed = kind == PortKind::dome ? 0.01 : 0.03;  // [m]
  KindTrial trial{kind, part, {}, 0};
  if (!is_stated)
    for (BundleCamera& camera : trial.bundle.cameras) camera.measured.port = usual_port(kind);
  triangulate(trial.bundle);
  static_cast<Unknowns&>(trial.options) = unknowns_of(kind, is_stated ? kMeasured : guessed);
  if (!options.distances.empty() || !options.positions.empty())
    trial.options.distances = held_length(part);
  trial.options.max_iterations = 40;
  fit(trial);
  return trial;
}

std::vector<KindTrial> trials_of(const Bundle& part, PortKind stated,
                                 const AdjustOptions& options) {
  // With usual numbers, the stated kind fits even if its stated numbers are far off.
  KindTrial as_stated = first_fit(stated, part, true, options);
  KindTrial as_usual = first_fit(stated, part, false, options);
  std::vector<KindTrial> trials;
  trials.push_back(std::move(as_usual.cost < as_stated.cost ? as_usual : as_stated));
  for (const PortKind kind : {PortKind::none, PortKind::flat, PortKind::dome})
    if (kind != stated) trials.push_back(first_fit(kind, part, false, options));
  return trials;
}

}  // namespace

PortKind kind_of(const std::optional<refractive::Port<double>>& port) {
  if (!port) return PortKind::none;
  return std::holds_alternative<refractive::FlatPort<double>>(*port) ? PortKind::flat
                                                                     : PortKind::dome;
}

std::string_view words_for(PortKind kind) {
  switch (kind) {
    case PortKind::none:
      return "no port";
    case PortKind::flat:
      return "a flat port";
    case PortKind::dome:
      return "a dome";
  }
  return {};
}

std::optional<refractive::Port<double>> usual_port(PortKind kind) {
  constexpr double kAirIndex = 1, kGlassIndex = 1.5, kWaterIndex = 1.339;
  constexpr double kDistance = 0.05, kRadius = 0.06;  // [m]
  switch (kind) {
    case PortKind::none:
      return {};
    case PortKind::flat:
      return refractive::FlatPort<double>{{0, 0, 1}, kDistance,   kGlass,
                                          kAirIndex, kGlassIndex, kWaterIndex};
    case PortKind::dome:
      return refractive::DomePort<double>{{0, 0, 0}, kRadius,     kGlass,
                                          kAirIndex, kGlassIndex, kWaterIndex};
  }
  return {};
}

std::vector<KindFit> fits_of_kinds(const Bundle& bundle, const AdjustOptions& options) {
  const Bundle part = sample_bundle(bundle, kLimits, false);
  if (part.images.size() < kFewestImages || part.points.size() < kFewestPoints) return {};
  const PortKind stated = kind_of(part.cameras.front().measured.port);
  if (std::ranges::any_of(part.cameras, [&](const BundleCamera& camera) {
        return kind_of(camera.measured.port) != stated;
      }))
    return {};
  std::vector<KindTrial> trials = trials_of(part, stated, options);
  if (!std::isfinite(trials.front().cost)) return {};
  std::erase_if(trials, [](const KindTrial& trial) { return !std::isfinite(trial.cost); });
  const auto count = static_cast<double>(part.observations.size());
  // Measured numbers and errors are comparable if the errors are in standard deviations: of the
  // noise that the best kind leaves.
  const double least = std::ranges::min(trials, {}, &KindTrial::cost).cost;
  const double noise = std::max(kFinestNoise, std::sqrt(least / count));
  std::vector<KindFit> fits;
  for (KindTrial& trial : trials) {
    trial.options.pixel_sigma = noise;
    trial.options.loss_sigmas = 2 / noise;
    fit(trial);
    fits.push_back({trial.kind, noise * std::sqrt(2 * trial.cost / count), 2 * trial.cost,
                    strain_of(trial.bundle, trial.options)});
  }
  if (!std::isfinite(fits.front().error)) return {};
  std::erase_if(fits, [](const KindFit& one) { return !std::isfinite(one.error); });
  std::ranges::sort(fits.begin() + 1, fits.end(), {}, &KindFit::error);
  return fits;
}

std::optional<KindFit> better_kind(const std::vector<KindFit>& fits) {
  if (fits.size() < 2 || !(fits[1].cost < fits[0].cost - kLeastGain)) return {};
  const bool is_strained = fits[0].strain > kStrained && fits[1].strain < fits[0].strain / 2;
  if (!(fits[1].error < kBetter * fits[0].error) && !is_strained) return {};
  if (fits.size() > 2 && fits[2].kind == PortKind::none && fits[1].error > kAlike * fits[2].error)
    return fits[2];
  return fits[1];
}

}  // namespace axial::pose
