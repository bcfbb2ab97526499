// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/view_selection.h"

#include <fmt/format.h>

#include <algorithm>

namespace axial {
namespace {

// The reason why an image is unsuitable as a source view; null if it is suitable.
const char* unsuitable_for(const ViewScore& view, const ViewSelectionOptions& options) {
  const auto scale = static_cast<double>(view.scale), angle = static_cast<double>(view.angle);
  if (angle < options.min_angle) return "seen under too small an angle";
  if (angle > options.max_angle) return "seen under too large an angle";
  if (scale < options.min_scale || scale > options.max_scale) return "of too different a scale";
  if (static_cast<double>(view.area) < options.min_area) return "sharing too small an area";
  return nullptr;
}

}  // namespace

std::string why_no_source_view(const std::vector<ViewScore>& neighbours,
                               const ViewSelectionOptions& options) {
  std::vector<std::pair<std::string, std::size_t>> reasons;
  for (const ViewScore& view : neighbours) {
    const char* unsuitable = unsuitable_for(view, options);
    const std::string reason = unsuitable ? unsuitable : "sharing too few points";
    const auto known = std::ranges::find(reasons, reason, &decltype(reasons)::value_type::first);
    if (known == reasons.end())
      reasons.emplace_back(reason, 1);
    else
      ++known->second;
  }
  std::string text =
      fmt::format("no suitable source view: {} images have common points", neighbours.size());
  for (std::size_t i = 0; i < reasons.size(); ++i)
    text += fmt::format("{}{} {}", i == 0 ? ", " : " and ", reasons[i].second, reasons[i].first);
  return text;
}

std::vector<ViewScore> filter_neighbours(const std::vector<ViewScore>& neighbours,
                                         const ViewSelectionOptions& options) {
  std::vector<ViewScore> result = neighbours;
  const std::size_t keep = std::max<std::size_t>(4, options.max_views * 3 / 4);
  for (std::size_t i = result.size(); i-- > 0 && result.size() > keep;) {
    if (unsuitable_for(result[i], options))
      result.erase(result.begin() + static_cast<std::ptrdiff_t>(i));
  }
  if (result.size() > options.max_views) result.resize(options.max_views);
  result.shrink_to_fit();
  return result;
}

std::vector<ViewScore> choose_source_views(const std::vector<ViewScore>& filtered,
                                           std::size_t number_views,
                                           const ViewSelectionOptions& options) {
  std::vector<ViewScore> result;
  if (filtered.empty()) return result;
  const double least = std::max(
      options.min_score, options.min_score_ratio * static_cast<double>(filtered.front().score));
  for (const ViewScore& view : filtered) {
    if (number_views > 0 && result.size() == number_views) break;
    if (static_cast<double>(view.score) >= least) result.push_back(view);
  }
  return result;
}

}  // namespace axial
