// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/table_columns.h"

#include <array>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "io/cameras/table_text.h"

namespace axial::control {
namespace {

// Names that positions of photographs do not have.
constexpr std::array<std::pair<std::string_view, Meaning>, 22> kNames{{
    {"marker", Meaning::label},       {"target", Meaning::label},
    {"point", Meaning::label},        {"gcp", Meaning::label},
    {"id", Meaning::label},           {"acc", Meaning::sigma},
    {"xyacc", Meaning::sigma_xy},     {"xy acc", Meaning::sigma_xy},
    {"xacc", Meaning::sigma_x},       {"accuracy x", Meaning::sigma_x},
    {"sigma x", Meaning::sigma_x},    {"yacc", Meaning::sigma_y},
    {"accuracy y", Meaning::sigma_y}, {"sigma y", Meaning::sigma_y},
    {"zacc", Meaning::sigma_z},       {"z acc", Meaning::sigma_z},
    {"check", Meaning::check},        {"check point", Meaning::check},
    {"checkpoint", Meaning::check},   {"enabled", Meaning::enabled},
    {"enable", Meaning::enabled},     {"enabled flag", Meaning::enabled},
}};

Meaning meaning_of_position(const std::string& words) {
  switch (io::column_of(words)) {
    case io::Column::label:
      return Meaning::label;
    case io::Column::x:
      return Meaning::x;
    case io::Column::y:
      return Meaning::y;
    case io::Column::z:
      return Meaning::z;
    case io::Column::depth:
      return Meaning::depth;
    case io::Column::sigma:
      return Meaning::sigma;
    case io::Column::sigma_across:
      return Meaning::sigma_xy;
    case io::Column::sigma_up:
      return Meaning::sigma_z;
    case io::Column::other:
      break;
  }
  return Meaning::other;
}

// "label" for "gis label".
std::string without_prefix(std::string words) {
  for (const std::string_view of_plate : {"gis ", "marker ", "target ", "gcp "})
    if (words.starts_with(of_plate)) words.erase(0, of_plate.size());
  return words;
}

Meaning meaning_of(const std::string& words) {
  const auto* const found =
      std::ranges::find(kNames, words, &std::pair<std::string_view, Meaning>::first);
  return found != kNames.end() ? found->second : meaning_of_position(words);
}

}  // namespace

Header header_of(const std::vector<std::string>& names, char delimiter, const std::string& where) {
  Header header;
  header.delimiter = delimiter;
  for (const std::string& field : names) {
    io::ColumnName name = io::column_name(field);
    name.words = without_prefix(std::move(name.words));
    Meaning meaning = meaning_of(name.words);
    if (meaning != Meaning::check && meaning != Meaning::enabled && header.has(meaning))
      meaning = Meaning::other;
    const bool is_place = meaning == Meaning::x || meaning == Meaning::y || meaning == Meaning::z ||
                          meaning == Meaning::depth;
    if (is_place && !io::is_known_unit(name.unit))
      fail_in(where, "column '{}' is in '{}', but must be in metres or degrees", name.words,
              name.unit);
    header.degrees |= is_place && io::means_degrees(name);
    header.may_be_degrees |= is_place && io::names_degrees(name.words);
    header.columns.push_back(meaning);
  }
  return header;
}

}  // namespace axial::control
