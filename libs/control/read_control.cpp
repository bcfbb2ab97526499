// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/read_control.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "base/byte_order_mark.h"
#include "base/error.h"
#include "base/split.h"
#include "control/labels.h"
#include "io/cameras/table_text.h"
#include "private/coordinate_system.h"
#include "private/readers.h"

namespace axial::control {
namespace {

Control read_any(const std::filesystem::path& file, const ControlReading& options) {
  std::string text = io::read_table_text(file);
  text.erase(0, text.size() - without_byte_order_mark(text).size());
  const std::string_view content = trimmed(text);
  if (content.empty()) fail_in(file, "is empty");
  if (content.starts_with('{')) return read_json_control(text, file, options);
  if (content.starts_with('<')) return read_markers_xml(text, file, options);
  if (is_gcp_list(text)) return read_gcp_list(text, file, options);
  return read_table(text, file, options);
}

// The end of the message about another part: ", but scale bars".
std::string contents_of(const Control& control) {
  std::string words;
  const auto add = [&](bool there, const char* what) {
    if (there) words += (words.empty() ? "" : " and ") + std::string(what);
  };
  add(!control.images.empty(), "targets in photographs");
  add(!control.points.empty(), "control points");
  add(!control.bars.empty(), "scale bars");
  return words.empty() ? words : ", but " + words;
}

void require_role(const Control& control, Role role, const std::filesystem::path& file) {
  const auto require = [&](bool there, const char* what) {
    if (!there) fail_in(file, "has no {}{}", what, contents_of(control));
  };
  if (role == Role::images) require(!control.images.empty(), "targets in photographs");
  if (role == Role::points) require(!control.points.empty(), "control points");
  if (role == Role::bars) require(!control.bars.empty(), "scale bars");
}

bool same_thing(const ControlPoint& a, const ControlPoint& b) {
  return same_label(a.label, b.label);
}

bool same_thing(const Bar& a, const Bar& b) {
  return same_targets(a, b);
}

bool same_numbers(const ControlPoint& a, const ControlPoint& b) {
  return a.metres == b.metres && a.sigma == b.sigma;
}

bool same_numbers(const Bar& a, const Bar& b) {
  return a.metres == b.metres && a.sigma == b.sigma;
}

const std::string& name_of(const ControlPoint& point) {
  return point.label;
}

bool has_plane(const ControlPoint& point) {
  return point.knows(0) && point.knows(1);
}

template <class Item>
void append_new(std::vector<Item>& items, const std::vector<Item>& more) {
  for (const Item& item : more) {
    const auto known =
        std::ranges::find_if(items, [&](const Item& other) { return same_thing(item, other); });
    if (known == items.end()) {
      items.push_back(item);
      continue;
    }
    if (!same_numbers(item, *known))
      fail_in(item.where, "{} has other numbers than at {}", name_of(item), known->where);
    known->check |= item.check;
  }
}

}  // namespace

void append(Control& control, Control more) {
  const auto known = std::ranges::find_if(control.points, has_plane);
  const auto other = std::ranges::find_if(more.points, has_plane);
  if (known != control.points.end() && other != more.points.end() && control.crs != more.crs)
    fail_in(other->where, "the points are in the system '{}', but those of {} are in '{}'",
            more.crs, known->where, control.crs);
  if (other != more.points.end()) control.crs = more.crs;
  append_new(control.points, more.points);
  append_new(control.bars, more.bars);
  std::ranges::move(more.images, std::back_inserter(control.images));
  std::ranges::move(more.notes, std::back_inserter(control.notes));
}

void set_map_scale(Control& control) {
  constexpr double kMatters = 1e-5;
  control.map_scale = 1;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (const ControlPoint& point : control.points)
    if (has_plane(point)) sum += point.metres.head<2>(), ++count;
  const auto system = control.crs.empty() ? std::nullopt : CoordinateSystem::from_text(control.crs);
  if (count == 0 || !system) return;
  const double scale = system->map_scale(sum / count);
  if (std::isfinite(scale) && std::abs(scale - 1) > kMatters) control.map_scale = scale;
}

Control read_control(const std::filesystem::path& file, const ControlReading& options) {
  Control control = read_any(file, options);
  require_role(control, options.role, file);
  return control;
}

}  // namespace axial::control
