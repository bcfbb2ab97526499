// SPDX-License-Identifier: GPL-3.0-or-later
// Tables as spreadsheets and other programs write them: text, fields, numbers, names of columns.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axial::io {

// The text of the file, with lines that end in a newline. Spreadsheets on old systems end lines
// with a carriage return alone. Error that names the file if it cannot be read or is UTF-16.
std::string read_table_text(const std::filesystem::path& file);

// Removes and returns the quoted text at the beginning of `text`, in which "" stands for one quote;
// nothing if the quote is not closed. Precondition: the text begins with a quote.
std::optional<std::string> take_quoted(std::string_view& text);

// The fields of `text` between delimiters, without blanks around them. A field in double quotes may
// contain delimiters; "" between the quotes stands for one quote. Nothing if a quote is not closed.
std::optional<std::vector<std::string>> split_fields(std::string_view text, char delimiter);

// The number that the whole field represents; its decimal mark may be a comma. Also infinite
// numbers and NaN.
std::optional<double> number_in(std::string_view field);

// The name of a column in plain words, and its unit.
struct ColumnName {
  std::string words;  // in small letters, one blank between two words
  std::string unit;   // the text in brackets
};
ColumnName column_name(std::string_view field);

// The meaning of a column. `depth` is positive downwards. The sigmas are standard deviations: of
// all coordinates, of the two horizontal ones, of the height.
enum class Column { other, label, x, y, z, depth, sigma, sigma_across, sigma_up };
// `words`: ColumnName::words.
Column column_of(const std::string& words);

// Whether a name leaves no other meaning than degrees: "longitude", but not "x/longitude".
bool means_degrees(const ColumnName& name);
// Whether a name contains a longitude or latitude: "x/longitude", too.
bool names_degrees(const std::string& words);
// Whether a word, in small letters, is the name of the metre.
bool is_metre(std::string_view word);
// Whether a column states that its unit is the metre.
bool means_metres(const ColumnName& name);
// Whether the unit is empty, the metre or the degree.
bool is_known_unit(const std::string& unit);

}  // namespace axial::io
