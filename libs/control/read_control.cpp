// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/read_control.h"

#include "base/byte_order_mark.h"
#include "base/error.h"
#include "base/split.h"
#include "io/cameras/table_text.h"
#include "private/readers.h"

namespace axial::control {
namespace {

Control read_any(const std::filesystem::path& file, const ControlReading& options) {
  std::string text = io::read_table_text(file);
  text.erase(0, text.size() - without_byte_order_mark(text).size());
  const std::string_view content = trimmed(text);
  if (content.empty()) fail("{}: is empty", file.string());
  if (content.starts_with('{')) return read_json_control(text, file, options);
  if (content.starts_with('<')) return read_markers_xml(text, file, options);
  if (is_gcp_list(text)) return read_gcp_list(text, file, options);
  return read_table(text, file, options);
}

std::string contents_of(const Control& control) {
  std::string words;
  const auto add = [&](bool there, const char* what) {
    if (there) words += (words.empty() ? "" : " and ") + std::string(what);
  };
  add(!control.images.empty(), "targets in photographs");
  add(!control.points.empty(), "control points");
  add(!control.bars.empty(), "scale bars");
  return words.empty() ? "nothing" : words;
}

void require_role(const Control& control, Role role, const std::filesystem::path& file) {
  const auto require = [&](bool there, const char* what) {
    if (!there) fail("{}: has no {}, but {}", file.string(), what, contents_of(control));
  };
  if (role == Role::images) require(!control.images.empty(), "targets in photographs");
  if (role == Role::points) require(!control.points.empty(), "control points");
  if (role == Role::bars) require(!control.bars.empty(), "scale bars");
}

}  // namespace

Control read_control(const std::filesystem::path& file, const ControlReading& options) {
  Control control = read_any(file, options);
  require_role(control, options.role, file);
  return control;
}

}  // namespace axial::control
