// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/port_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/order_statistics.h"
#include "pose/bundle/tracks.h"
#include "pose/refine.h"

namespace axial::diagnosis {
namespace {

using Of = PortChange::Of;
using Flat = refractive::FlatPort<double>;
using Dome = refractive::DomePort<double>;
using Camera = pose::HousedCamera;

constexpr double kWater = 1.333;
constexpr double kLeastNoise = 0.5;  // [px]
constexpr const char* kUseTheLens = "use the lens calibrated in air, at this image size";

// A change of each camera.
template <class Change>
std::function<void(pose::Bundle&)> of_cameras(const Change& change) {
  return [change](pose::Bundle& bundle) {
    for (pose::BundleCamera& camera : bundle.cameras) change(camera.measured);
  };
}

// A change of each port of one kind.
template <class Kind, class Change>
std::function<void(pose::Bundle&)> of_ports(const Change& change) {
  return of_cameras([change](Camera& camera) {
    if (camera.port)
      if (Kind* const port = std::get_if<Kind>(&*camera.port)) change(*port);
  });
}

void scale_focal_lengths(Camera& camera, double factor) {
  camera.lens.pinhole.fx *= factor;
  camera.lens.pinhole.fy *= factor;
}

std::string times(double factor) {
  return factor > 1 ? fmt::format("{:.6g} times too large", factor)
                    : fmt::format("{:.6g} times too small", 1 / factor);
}

PortChange without_ports() {
  return {Of::port_left_out, of_cameras([](Camera& camera) { camera.port.reset(); }),
          "the poses were computed without the port, for a pinhole camera",
          "RefinePoses, with the lens calibrated in air, computes refractive poses from them"};
}

// A port that is not given: a flat port of zero thickness that almost touches the lens, or focal
// lengths times the index of the water, which has nearly the same effect. The user need not state
// dimensions of a port.
void add_thin_ports(std::vector<PortChange>& changes) {
  const std::string cause = "the photographs were taken through a port that is not given";
  const auto add = [&](const auto& change) {
    changes.push_back({Of::thin_port, of_cameras([change](Camera& camera) {
                         if (!camera.port) change(camera);
                       }),
                       cause, "give the housing"});
  };
  add([](Camera& camera) { camera.port = Flat{{0, 0, 1}, 1e-6, 0, 1, 1.5, kWater}; });
  add([](Camera& camera) { scale_focal_lengths(camera, kWater); });
}

void add_numbers(const Flat& port, std::vector<PortChange>& changes) {
  const double cosine = std::clamp(port.normal.normalized().z(), -1.0, 1.0);
  const double tilt = std::acos(cosine) * 180 / std::numbers::pi;
  if (tilt > 2)
    changes.push_back(
        {Of::normal, of_ports<Flat>([](Flat& one) {
           one.normal = {0, 0, 1};
         }),
         fmt::format("the port's normal, {:.3g} degrees off the optical axis (a normal along the "
                     "axis fits)",
                     tilt)});
  for (const double factor : {0.1, 10.0})
    changes.push_back({Of::distance, of_ports<Flat>([=](Flat& one) { one.distance *= factor; }),
                       fmt::format("the port's distance is {}", times(1 / factor))});
}

void add_numbers(const Dome&, std::vector<PortChange>& changes) {
  changes.push_back({Of::centre, of_ports<Dome>([](Dome& one) { one.centre.setZero(); }),
                     "the dome's centre (a centre at the camera centre fits)"});
}

void add_index(double n_water, std::vector<PortChange>& changes) {
  if (!(std::abs(n_water - kWater) > 0.015)) return;
  const auto change = [](Camera& camera) {
    if (camera.port) std::visit([](auto& port) { port.n_water = kWater; }, *camera.port);
  };
  changes.push_back(
      {Of::index, of_cameras(change),
       fmt::format("the water's index n_water {:.6g} ({:.6g} fits)", n_water, kWater)});
}

void add_scales(std::vector<PortChange>& changes) {
  for (const double scale : {0.001, 1000.0, 0.1, 10.0, 0.01, 100.0})
    changes.push_back(
        {Of::scale, [=](pose::Bundle& bundle) { scale_places(bundle, scale); },
         fmt::format("the model's lengths are {} relative to the port's lengths, as with another "
                     "unit",
                     times(1 / scale)),
         "scale the model to metres with AlignModel or RefinePoses; the port's lengths must also "
         "be in metres"});
}

void add_focal_lengths(bool behind_port, std::vector<PortChange>& changes) {
  constexpr double kFactors[] = {1 / kWater, kWater, 0.5, 2};
  for (const double factor : kFactors)
    if (behind_port || factor != kWater)
      changes.push_back({Of::focal,
                         of_cameras([=](Camera& camera) { scale_focal_lengths(camera, factor); }),
                         fmt::format("the focal length is {}, as with another lens or image size",
                                     times(1 / factor)),
                         kUseTheLens});
  for (const double factor : kFactors)
    if (behind_port)
      changes.push_back(
          {Of::focal_in_air, of_cameras([=](Camera& camera) {
             scale_focal_lengths(camera, factor);
             camera.port.reset();
           }),
           fmt::format("the tracks fit in air, with a focal length that is {:.4g} times the given "
                       "one: another lens, or poses computed without the port",
                       factor),
           std::string(kUseTheLens) +
               "; RefinePoses computes refractive poses from the poses of pinhole cameras"});
}

// Of the first camera with a port: the ports of a bundle seldom differ in their values, and the
// cause names only one value.
const refractive::Port<double>* first_port(const pose::Bundle& bundle) {
  for (const pose::BundleCamera& camera : bundle.cameras)
    if (camera.measured.port) return &*camera.measured.port;
  return nullptr;
}

}  // namespace

pose::Bundle changed(const pose::Bundle& bundle, const PortChange& change) {
  pose::Bundle result = bundle;
  if (change.apply) change.apply(result);
  return result;
}

std::vector<PortChange> likely_changes(const pose::Bundle& bundle) {
  std::vector<PortChange> changes;
  const refractive::Port<double>* const port = first_port(bundle);
  if (!port) add_thin_ports(changes);
  if (port) {
    changes.push_back(without_ports());
    std::visit(
        [&](const auto& one) {
          add_index(one.n_water, changes);
          add_numbers(one, changes);
        },
        *port);
    add_scales(changes);
  }
  add_focal_lengths(port != nullptr, changes);
  return changes;
}

double track_residual(pose::Bundle bundle) {
  if (bundle.observations.empty()) return std::numeric_limits<double>::infinity();
  triangulate(bundle);
  std::vector<double> errors = reprojection_errors(bundle);
  for (double& error : errors)
    if (!std::isfinite(error)) error = std::numeric_limits<double>::infinity();
  return upper_median(std::move(errors));
}

PortCheck check_ports(const pose::Bundle& bundle, std::span<const double> claimed_errors) {
  PortCheck check;
  check.points = bundle.points.size();
  check.observations = bundle.observations.size();
  check.noise = std::max(
      kLeastNoise, upper_median(std::vector<double>(claimed_errors.begin(), claimed_errors.end())));
  check.residual = track_residual(bundle);
  check.in_air =
      first_port(bundle) ? track_residual(changed(bundle, without_ports())) : check.residual;
  check.best_residual = check.residual;
  if (check.fits()) return check;
  // Takes the likeliest of the changes that explain the tracks about equally well. If no change
  // brings the errors down to the noise, residuals rank the changes less reliably, and the
  // tolerance is wider.
  const std::vector<PortChange> changes = likely_changes(bundle);
  std::vector<double> residuals;
  residuals.reserve(changes.size());
  for (const PortChange& change : changes)
    residuals.push_back(track_residual(changed(bundle, change)));
  const double least = *std::ranges::min_element(residuals);
  const double alike = least > 3 * check.noise ? 1.3 * least : 1.05 * least + 0.02;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (residuals[i] > alike || residuals[i] >= check.residual) continue;
    check.best = changes[i];
    check.best_residual = residuals[i];
    break;
  }
  return check;
}

}  // namespace axial::diagnosis
