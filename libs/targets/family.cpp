// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/family.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/split.h"
#include "targets/dictionary.h"
#include "targets/ring_codes.h"

namespace axial::targets {

Family parse_family(const std::string& text) {
  constexpr std::array kBits{12, 14, 16, 20};
  for (const int bits : kBits)
    if (text == fmt::format("circular{}", bits)) return {text, Kind::ring, bits, 0};
  if (const auto number = dictionary_number(text)) return {text, Kind::square, 0, *number};
  fail(
      "'{}' is not a family of targets: circular12, circular14, circular16, circular20, or a "
      "dictionary of OpenCV's markers (APRILTAG_36h11, 4X4_50, ...)",
      text);
}

std::vector<Family> parse_families(const std::string& text) {
  std::vector<Family> families;
  for (const auto word : split(text, ',')) {
    Family family = parse_family(std::string(word));
    const auto same = std::ranges::find(families, family.kind, &Family::kind);
    if (same != families.end())
      fail("'{}': {} and {} would have equal labels; search one of them", text, same->name,
           family.name);
    families.push_back(std::move(family));
  }
  if (families.empty()) fail("'{}' names no family of targets", text);
  return families;
}

Numbers numbers_of(const Family& family) {
  if (family.kind == Kind::ring) return {1, ring_codes(family.bits).size()};
  return {0, static_cast<std::size_t>(dictionary(family.dictionary)->bytesList.rows) - 1};
}

std::string label_of(const Family& family, std::size_t number) {
  return fmt::format("{} {}", family.kind == Kind::ring ? "target" : "tag", number);
}

}  // namespace axial::targets
