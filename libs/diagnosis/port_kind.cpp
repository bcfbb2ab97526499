// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/port_kind.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "diagnosis/track_sample.h"
#include "pose/adjust/free_numbers.h"
#include "pose/bundle/tracks.h"

namespace axial::diagnosis {
namespace {

constexpr double kBetter = 0.95;       // times the error
constexpr double kLeastGain = 36;      // of the cost, in squared standard deviations
constexpr double kStrained = 4;        // standard deviations of a number
constexpr double kAlike = 0.98;        // times the error
constexpr double kFinestNoise = 0.05;  // [px]
constexpr double kGlass = 0.008;       // [m]

// The largest change of a number, in its standard deviations.
double strain_of(const pose::Bundle& bundle, const pose::Unknowns& unknowns) {
  double strain = 0;
  for (const pose::BundleCamera& camera : bundle.cameras)
    for (std::size_t k = 0; k < unknowns.free.size(); ++k)
      if (unknowns.free[k])
        strain = std::max(strain, std::abs(camera.change(static_cast<Eigen::Index>(k))) /
                                      unknowns.prior_sigma[k]);
  return strain;
}

// A kind of port in a bundle that is being fitted.
struct KindTrial {
  pose::PortKind kind = pose::PortKind::none;
  pose::Bundle bundle;
  pose::AdjustOptions options;
  double cost = 0;  // half the cost of adjust(); infinite if it failed
};

void fit(KindTrial& trial) {
  try {
    trial.cost = adjust(trial.bundle, trial.options).final_cost;
  } catch (const Error&) {
    trial.cost = std::numeric_limits<double>::infinity();
  }
}

KindTrial first_fit(pose::PortKind kind, const pose::Bundle& part, bool is_stated,
                    const pose::AdjustOptions& options) {
  pose::Sigmas sigmas = is_stated ? pose::ruler_sigmas() : usual_sigmas();
  sigmas.thickness = 0;
  KindTrial trial{kind, part, {}, 0};
  if (!is_stated)
    for (pose::BundleCamera& camera : trial.bundle.cameras) camera.measured.port = usual_port(kind);
  triangulate(trial.bundle);
  static_cast<pose::Unknowns&>(trial.options) = pose::unknowns_with(kind, sigmas);
  if (options.know_lengths()) trial.options.distances = held_length(part);
  trial.options.max_iterations = 40;
  fit(trial);
  return trial;
}

std::vector<KindTrial> trials_of(const pose::Bundle& part, pose::PortKind stated,
                                 const pose::AdjustOptions& options) {
  // With usual numbers, the stated kind fits even if its stated numbers are far off.
  KindTrial as_stated = first_fit(stated, part, true, options);
  KindTrial as_usual = first_fit(stated, part, false, options);
  std::vector<KindTrial> trials;
  trials.push_back(std::move(as_usual.cost < as_stated.cost ? as_usual : as_stated));
  for (const pose::PortKind kind :
       {pose::PortKind::none, pose::PortKind::flat, pose::PortKind::dome})
    if (kind != stated) trials.push_back(first_fit(kind, part, false, options));
  return trials;
}

}  // namespace

std::optional<refractive::Port<double>> usual_port(pose::PortKind kind) {
  constexpr double kAirIndex = 1, kGlassIndex = 1.5, kWaterIndex = 1.339;
  constexpr double kDistance = 0.05, kRadius = 0.06;  // [m]
  switch (kind) {
    case pose::PortKind::none:
      return {};
    case pose::PortKind::flat:
      return refractive::FlatPort<double>{{0, 0, 1}, kDistance,   kGlass,
                                          kAirIndex, kGlassIndex, kWaterIndex};
    case pose::PortKind::dome:
      return refractive::DomePort<double>{{0, 0, 0}, kRadius,     kGlass,
                                          kAirIndex, kGlassIndex, kWaterIndex};
  }
  return {};
}

pose::Sigmas usual_sigmas() {
  return {.normal_degrees = 3, .distance = 0.03, .centre = 0.01, .index = 0.004, .focal = 0.005};
}

std::vector<KindFit> fits_of_kinds(const pose::Bundle& bundle, const pose::AdjustOptions& options) {
  const pose::Bundle part = sample_bundle(bundle, 600, false);
  const std::optional<pose::PortKind> stated = common_kind(part);
  if (!is_enough(part) || !stated) return {};
  std::vector<KindTrial> trials = trials_of(part, *stated, options);
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
  if (fits.size() > 2 && fits[2].kind == pose::PortKind::none &&
      fits[1].error > kAlike * fits[2].error)
    return fits[2];
  return fits[1];
}

}  // namespace axial::diagnosis
