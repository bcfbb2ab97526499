// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/codes/family.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/split.h"
#include "targets/codes/dictionary.h"
#include "targets/codes/ring_codes.h"

namespace axial::targets {
namespace {

Family family_or_board(const std::string& text) {
  if (!text.starts_with("charuco:")) return parse_family(text);
  return {.name = text, .kind = Kind::board, .board = parse_board(text)};
}

}  // namespace

Family parse_family(const std::string& text) {
  constexpr std::array kBits{12, 14, 16, 20};
  for (const int bits : kBits)
    if (text == fmt::format("circular{}", bits))
      return {.name = text, .kind = Kind::ring, .bits = bits};
  if (const auto number = dictionary_number(text))
    return {.name = text, .kind = Kind::square, .dictionary = *number};
  fail(
      "'{}' is not a family of targets: circular12, circular14, circular16, circular20, or a "
      "dictionary of OpenCV's markers (APRILTAG_36h11, 4X4_50, ...)",
      text);
}

std::vector<Family> parse_families(const std::string& text) {
  std::vector<Family> families;
  for (const auto word : split(text, ',')) {
    Family family = family_or_board(std::string(word));
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
  if (family.kind == Kind::board) return {0, corners_of(family.board).size() - 1};
  return {0, static_cast<std::size_t>(dictionary(family.dictionary)->bytesList.rows) - 1};
}

std::size_t code_of(const Family& family, std::size_t number) {
  return family.kind == Kind::ring ? ring_codes(family.bits).at(number - 1) : number;
}

std::string label_of(const Family& family, std::size_t number) {
  if (!family.labels.empty()) {
    const auto found = family.labels.find(number);
    if (found != family.labels.end()) return found->second;
    return fmt::format("code {}", code_of(family, number));
  }
  switch (family.kind) {
    case Kind::ring:
      return fmt::format("target {}", number);
    case Kind::square:
      return fmt::format("tag {}", number);
    case Kind::board:
      break;
  }
  return fmt::format("board corner {}", number);
}

}  // namespace axial::targets
