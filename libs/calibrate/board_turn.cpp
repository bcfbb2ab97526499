// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/board_turn.h"

#include <limits>
#include <utility>

#include "calibrate/board_pose.h"

namespace axial::calibrate {
namespace {

// The RMS of the errors of each view. Infinite for a view whose corners determine no pose.
std::vector<double> least_errors(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                                 std::span<const View> views,
                                 std::span<const Eigen::Vector3d> corners) {
  pose::Bundle bundle = board_bundle(lens, port, views, corners).bundle;
  place_boards(bundle);
  std::vector<double> least;
  for (const std::vector<double>& errors : reprojection_errors_by_image(bundle))
    least.push_back(errors.empty() ? std::numeric_limits<double>::infinity()
                                   : pose::root_mean_square(errors));
  return least;
}

}  // namespace

bool choose_turns(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                  std::span<View> views, std::span<const Eigen::Vector3d> corners) {
  std::vector<std::size_t> open;
  std::vector<View> straight, turned;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].turned.empty()) continue;
    open.push_back(i);
    straight.push_back(views[i]);
    turned.push_back(views[i]);
    std::swap(turned.back().corners, turned.back().turned);
  }
  if (open.empty()) return false;
  const std::vector<double> now = least_errors(lens, port, straight, corners);
  const std::vector<double> then = least_errors(lens, port, turned, corners);
  bool changed = false;
  for (std::size_t k = 0; k < open.size(); ++k) {
    if (!(then[k] < now[k])) continue;
    views[open[k]] = std::move(turned[k]);
    changed = true;
  }
  return changed;
}

}  // namespace axial::calibrate
