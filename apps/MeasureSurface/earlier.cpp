// SPDX-License-Identifier: GPL-3.0-or-later
#include "earlier.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/log.h"
#include "compare/area_change.h"

namespace axial::apps {
namespace {

map::AreaValue named(const std::vector<map::AreaValue>& values, const std::string& name) {
  return *std::ranges::find(values, name, &map::AreaValue::name);
}

// The change of the seen surface. Not known if the surveys show different shares of the polygon.
map::AreaValue change_of_surface(const map::MeasuredArea& earlier, const map::MeasuredArea& later,
                                 double length_sigma) {
  constexpr double kPart = 0.01;
  map::AreaValue change{"surface_change_m2", map::kNotKnown, map::kNotKnown, 6};
  const double shares = std::abs(later.measures.planar - earlier.measures.planar);
  if (!later.measures.plane.is_known() || shares > kPart * later.measures.polygon) return change;
  const map::AreaValue before = named(values_of(earlier, 0), "seen_m2"),
                       after = named(values_of(later, 0), "seen_m2");
  change.value = after.value - before.value;
  // Both surveys have one scale, because they are in one frame.
  change.sigma = std::hypot(before.sigma, after.sigma, 2 * length_sigma * change.value);
  return change;
}

std::vector<map::AreaValue> values_of_change(const compare::AreaChange& change,
                                             double length_sigma) {
  const bool is_known = change.compared > 0;
  const auto volume = [&](const char* name, double value, double sigma) {
    if (!is_known) return map::AreaValue{name, map::kNotKnown, map::kNotKnown, 6};
    return map::AreaValue{name, value, std::hypot(sigma, 3 * length_sigma * value), 6};
  };
  // Changes below what can be found are not known to be 0.
  const auto found = [&](const char* name, const auto& part) {
    return volume(name, part.volume, part.volume > 0 ? part.sigma : map::kNotKnown);
  };
  const auto length = [&](const char* name, double value, double sigma, int digits) {
    return map::AreaValue{name, value, std::hypot(sigma, length_sigma * value), digits};
  };
  return {{"compared_m2", change.compared, map::kNotKnown, 6, false},
          found("gain_m3", change.came),
          found("loss_m3", change.gone),
          volume("net_m3", change.net, change.net_sigma),
          length("mean_change_m", change.mean, change.mean_sigma, 5),
          length("largest_change_m", change.largest, change.largest_sigma, 4)};
}

// Warns of polygons that the surveys do not both fill. Error if they are compared in none.
void report(const Settings& settings, const std::vector<map::MeasuredArea>& areas,
            const std::vector<compare::AreaChange>& changes) {
  constexpr double kPart = 0.02;  // pixels at the rim
  if (std::ranges::none_of(changes, [](const auto& change) { return change.compared > 0; }))
    fail_in(settings.earlier, "does not overlap {} in any polygon", settings.mesh.string());
  for (std::size_t i = 0; i < areas.size(); ++i)
    if (const double share = changes[i].compared / areas[i].measures.polygon; share < 1 - kPart)
      log_warning("polygon '{}': only {:.1f} % of it can be compared with the earlier survey",
                  areas[i].area.name, 100 * share);
}

}  // namespace

void add_changes(const Settings& settings, const Eigen::Vector3d& origin,
                 const MeasuredSurvey& earlier, const MeasuredSurvey& later,
                 const Context& context) {
  compare::CompareOptions options;
  options.name_before = settings.earlier;
  options.name_after = settings.mesh;
  options.allow_other_place = settings.allow_other_place;
  map::MapFrame frame;
  frame.origin = origin;
  const compare::Comparison comparison =
      compare::compare_surveys(earlier.mesh, later.mesh, frame, options, context);
  std::vector<compare::AreaChange> changes;
  for (const map::MeasuredArea& one : later.areas)
    changes.push_back(compare::change_in(comparison, one.area));
  report(settings, later.areas, changes);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    later.areas[i].more = values_of_change(changes[i], settings.length_sigma);
    later.areas[i].more.push_back(
        change_of_surface(earlier.areas[i], later.areas[i], settings.length_sigma));
  }
}

}  // namespace axial::apps
