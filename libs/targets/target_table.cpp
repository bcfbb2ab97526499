// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_table.h"

#include <fmt/format.h>

#include <optional>
#include <set>

#include "base/byte_order_mark.h"
#include "base/error.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "io/cameras/table_text.h"
#include "targets/codes/ring_codes.h"

namespace axial::targets {
namespace {

// The number of the target of this code.
std::optional<std::size_t> number_of_code(std::uint32_t code, const Family& family,
                                          std::span<const std::uint32_t> rings) {
  if (family.kind == Kind::ring) {
    if (code >> family.bits) return std::nullopt;
    return ring_number(code, family.bits, rings);
  }
  return code <= numbers_of(family).last ? std::optional<std::size_t>(code) : std::nullopt;
}

}  // namespace

void read_target_table(const std::filesystem::path& file, Family& family) {
  const std::string text = io::read_table_text(file);
  std::vector<std::uint32_t> rings;
  if (family.kind == Kind::ring) rings = ring_codes(family.bits);
  std::set<std::string> labels;
  int line_number = 0;
  for (const std::string_view line : split(without_byte_order_mark(text), '\n')) {
    const std::string where = fmt::format("{}:{}", file.string(), ++line_number);
    if (trimmed(line).empty() || trimmed(line).starts_with('#')) continue;
    const auto fields = io::split_fields(line, ',');
    if (!fields || fields->size() != 2 || fields->back().empty())
      fail_in(where, "must be CODE,LABEL");
    const std::string& label = fields->back();
    const auto code = parse_number<std::uint32_t>(fields->front());
    const auto number = code ? number_of_code(*code, family, rings) : std::nullopt;
    if (!number) fail_in(where, "'{}' is no code of {}", fields->front(), family.name);
    if (!labels.insert(label).second) fail_in(where, "the label '{}' occurs twice", label);
    if (!family.labels.emplace(*number, label).second)
      fail_in(where, "the code {} occurs twice", fields->front());
  }
  if (family.labels.empty()) fail_in(file, "has no line CODE,LABEL");
}

}  // namespace axial::targets
