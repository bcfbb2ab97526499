// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/port_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/order_statistics.h"
#include "pose/refine.h"
#include "pose/tracks.h"

namespace axial::pose {
namespace {

using Of = PortChange::Of;
using Flat = refractive::FlatPort<double>;
using Dome = refractive::DomePort<double>;

constexpr double kWater = 1.333;
constexpr double kLeastNoise = 0.5;  // [px]

void change_port(const PortChange& change, Flat& port) {
  if (change.of == Of::index) port.n_water = change.value;
  if (change.of == Of::distance) port.distance *= change.value;
  if (change.of == Of::normal) port.normal = {0, 0, 1};
}

void change_port(const PortChange& change, Dome& port) {
  if (change.of == Of::index) port.n_water = change.value;
  if (change.of == Of::centre) port.centre.setZero();
}

void change_camera(const PortChange& change, HousedCamera& camera) {
  refractive::PinholeLens<double>& lens = camera.lens.pinhole;
  if (change.of == Of::focal || change.of == Of::focal_in_air) {
    lens.fx *= change.value;
    lens.fy *= change.value;
  }
  if (change.of == Of::port_left_out || change.of == Of::focal_in_air) camera.port.reset();
  if (change.of == Of::thin_port && !camera.port) {
    if (change.value == 1) camera.port = Flat{{0, 0, 1}, 1e-6, 0, 1, 1.5, kWater};
    lens.fx *= change.value;
    lens.fy *= change.value;
  }
  if (camera.port) std::visit([&](auto& port) { change_port(change, port); }, *camera.port);
}

struct PortValues {
  double n_water = 0;
  double tilt = 0;  // [degrees], of a flat port
  bool flat = false;
};

PortValues values_of(const refractive::Port<double>& port) {
  if (const Flat* flat = std::get_if<Flat>(&port)) {
    const double cosine = std::clamp(flat->normal.normalized().z(), -1.0, 1.0);
    return {flat->n_water, std::acos(cosine) * 180 / std::numbers::pi, true};
  }
  return {std::get<Dome>(port).n_water, 0, false};
}

// Of the first camera with a port: the ports of a bundle seldom differ in these values, and the
// cause names only one value.
std::optional<PortValues> first_port(const Bundle& bundle) {
  for (const BundleCamera& camera : bundle.cameras)
    if (camera.measured.port) return values_of(*camera.measured.port);
  return {};
}

std::string times(double factor) {
  return factor > 1 ? fmt::format("{:.6g} times too large", factor)
                    : fmt::format("{:.6g} times too small", 1 / factor);
}

}  // namespace

Bundle changed(const Bundle& bundle, const PortChange& change) {
  Bundle result = bundle;
  for (BundleCamera& camera : result.cameras) change_camera(change, camera.measured);
  if (change.of == Of::scale) scale_places(result, change.value);
  return result;
}

std::vector<PortChange> likely_changes(const Bundle& bundle) {
  std::vector<PortChange> changes;
  const std::optional<PortValues> port = first_port(bundle);
  if (!port) changes = {{Of::thin_port}, {Of::thin_port, kWater}};
  if (port) {
    changes.push_back({Of::port_left_out});
    if (std::abs(port->n_water - kWater) > 0.015) changes.push_back({Of::index, kWater});
    if (port->tilt > 2) changes.push_back({Of::normal});
    if (port->flat) changes.insert(changes.end(), {{Of::distance, 0.1}, {Of::distance, 10}});
    if (!port->flat) changes.push_back({Of::centre});
    for (const double scale : {0.001, 1000.0, 0.1, 10.0, 0.01, 100.0})
      changes.push_back({Of::scale, scale});
  }
  constexpr double kFactors[] = {1 / kWater, kWater, 0.5, 2};
  for (const double factor : kFactors)
    if (port || factor != kWater) changes.push_back({Of::focal, factor});
  if (port)
    for (const double factor : kFactors) changes.push_back({Of::focal_in_air, factor});
  return changes;
}

double track_residual(Bundle bundle) {
  if (bundle.observations.empty()) return std::numeric_limits<double>::infinity();
  triangulate(bundle);
  std::vector<double> errors = reprojection_errors(bundle);
  for (double& error : errors)
    if (!std::isfinite(error)) error = std::numeric_limits<double>::infinity();
  return upper_median(std::move(errors));
}

PortCheck check_ports(const Bundle& bundle, std::span<const double> claimed_errors) {
  PortCheck check;
  check.points = bundle.points.size();
  check.observations = bundle.observations.size();
  check.noise = std::max(
      kLeastNoise, upper_median(std::vector<double>(claimed_errors.begin(), claimed_errors.end())));
  check.residual = track_residual(bundle);
  check.in_air =
      first_port(bundle) ? track_residual(changed(bundle, {Of::port_left_out})) : check.residual;
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

std::string cause_of(const PortChange& change, const Bundle& bundle) {
  const PortValues port = first_port(bundle).value_or(PortValues{});
  switch (change.of) {
    case Of::nothing:
      return "no single change explains the errors";
    case Of::port_left_out:
      return "the poses were computed without the port, for a pinhole camera";
    case Of::thin_port:
      return "the photographs were taken through a port that is not given";
    case Of::index:
      return fmt::format("the water's index n_water {:.6g} ({:.6g} fits)", port.n_water,
                         change.value);
    case Of::distance:
      return fmt::format("the port's distance is {}", times(1 / change.value));
    case Of::normal:
      return fmt::format(
          "the port's normal, {:.3g} degrees off the optical axis (a normal along the axis fits)",
          port.tilt);
    case Of::centre:
      return "the dome's centre (a centre at the camera centre fits)";
    case Of::scale:
      return fmt::format(
          "the model's lengths are {} relative to the port's lengths, as with another unit",
          times(1 / change.value));
    case Of::focal:
      return fmt::format("the focal length is {}, as with another lens or image size",
                         times(1 / change.value));
    case Of::focal_in_air:
      return fmt::format(
          "the tracks fit in air, with a focal length that is {:.4g} times the given one: another "
          "lens, or poses computed without the port",
          change.value);
  }
  return {};
}

std::string advice_for(const PortChange& change) {
  switch (change.of) {
    case Of::focal_in_air:
      return "use the lens calibrated in air, at this image size; RefinePoses computes refractive "
             "poses from the poses of pinhole cameras";
    case Of::port_left_out:
      return "RefinePoses, with the lens calibrated in air, computes refractive poses from them";
    case Of::thin_port:
      return "give the housing";
    case Of::scale:
      return "scale the model to metres with AlignModel or RefinePoses; the port's "
             "lengths must also be in metres";
    case Of::focal:
      return "use the lens calibrated in air, at this image size";
    default:
      return "check lens, port and scale; RefinePoses can adjust values that were "
             "measured with low precision";
  }
}

}  // namespace axial::pose
