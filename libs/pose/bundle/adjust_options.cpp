// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/adjust_options.h"

#include <algorithm>
#include <variant>

namespace axial::pose {

const Unknowns& AdjustOptions::unknowns(const BundleCamera& camera) const {
  const auto& port = camera.measured.port;
  if (!port) return of_air ? *of_air : *this;
  const bool dome = std::holds_alternative<refractive::DomePort<double>>(*port);
  if (dome && of_domes) return *of_domes;
  return *this;
}

double AdjustOptions::sigma_before(const BundleCamera& camera, int number) const {
  const Unknowns& of_camera = unknowns(camera);
  const auto k = static_cast<std::size_t>(number);
  if (of_camera.prior_sigma[k] > 0) return of_camera.prior_sigma[k];
  const double stated = camera.stated_sigma(number);
  return stated > 0 ? stated : of_camera.default_sigma[k];
}

bool AdjustOptions::know_lengths() const {
  const auto in_plan = [](const KnownPlace& place) { return place.knows(0) && place.knows(1); };
  return !distances.empty() || positions.size() >= 3 || std::ranges::count_if(places, in_plan) >= 2;
}

}  // namespace axial::pose
