// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/stated_check.h"

#include <fmt/format.h>

#include <cmath>

#include "pose/free_numbers.h"

namespace axial::pose {
namespace {

constexpr double kMostDeviations = 3;

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

}  // namespace

std::vector<std::string> lines_of_moved_numbers(const Bundle& refined,
                                                std::span<const std::string> ports,
                                                const AdjustOptions& options) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < refined.cameras.size(); ++i)
    for (const FreeValue& value :
         free_values(refined.cameras[i], HousingChange<double>::Zero(), options)) {
      if (!(value.sigma_before > 0)) continue;
      const double deviations = std::abs(value.now - value.before) / value.sigma_before;
      if (!(deviations > kMostDeviations)) continue;
      lines.push_back(fmt::format(
          "Camera {} behind {}: the photographs give {} {}, {:.1f} standard deviations from the "
          "stated {} +- {}: check this value, the lens in air and the kind of the port",
          i + 1, ports[i], value.name, with_unit(value.now, value.unit), deviations,
          with_unit(value.before, value.unit), with_unit(value.sigma_before, value.unit)));
    }
  return lines;
}

}  // namespace axial::pose
