// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/labels.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "base/error.h"
#include "base/file_extension.h"
#include "base/split.h"

namespace axial::control {
namespace {

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

// Labels may contain hyphens, too.
bool is_bar(const Bar& bar, std::string_view name) {
  for (std::size_t at = name.find('-'); at != std::string_view::npos; at = name.find('-', at + 1)) {
    const std::string_view first = name.substr(0, at), second = name.substr(at + 1);
    if (same_targets(bar, {std::string(first), std::string(second), 0, 0, false, {}})) return true;
  }
  return false;
}

// Calls use(item) for each point and each bar of this name. Returns whether there is one.
template <class AnyControl, class Use>
bool for_each_named(AnyControl& control, const std::string& name, Use use) {
  bool found = false;
  for (auto& point : control.points)
    if (same_label(point.label, name)) use(point), found = true;
  for (auto& bar : control.bars)
    if (is_bar(bar, name)) use(bar), found = true;
  return found;
}

}  // namespace

bool is_number(std::string_view label) {
  return !label.empty() && std::ranges::all_of(label, is_digit);
}

std::string label_key(std::string_view label) {
  std::string key;
  bool in_number = false;
  for (std::size_t i = 0; i < label.size(); ++i) {
    const char c = label[i];
    if (kBlanks.find(c) != std::string_view::npos || c == '_') continue;
    const bool leads = c == '0' && !in_number && i + 1 < label.size() && is_digit(label[i + 1]);
    if (leads) continue;
    in_number = is_digit(c);
    key += c;
  }
  key = lower_case(std::move(key));
  if (is_number(key)) key = "target" + key;
  return key;
}

bool same_label(std::string_view first, std::string_view second) {
  return label_key(first) == label_key(second);
}

bool same_targets(const Bar& a, const Bar& b) {
  return (same_label(a.first, b.first) && same_label(a.second, b.second)) ||
         (same_label(a.first, b.second) && same_label(a.second, b.first));
}

std::string name_of(const Bar& bar) {
  return bar.first + "-" + bar.second;
}

void mark_checks(Control& control, std::span<const std::string> names) {
  for (const std::string& name : names)
    if (!for_each_named(std::as_const(control), name, [](const auto&) {}))
      fail("check '{}': there is no control point and no bar of this name", name);
  for (const std::string& name : names)
    for_each_named(control, name, [](auto& item) { item.check = true; });
}

}  // namespace axial::control
