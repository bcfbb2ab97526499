// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/photograph_numbers.h"

#include <utility>

#include "base/atomic_file.h"
#include "bytes/private/text_reader.h"

namespace axial::io {

PhotographNumbers read_photograph_numbers(const std::filesystem::path& file,
                                          std::string_view column) {
  const std::string text = read_file(file);
  const std::string heading = fmt::format("name,{}", column);
  TextReader reader(text, file.string());
  PhotographNumbers numbers;
  bool first = true;
  while (const auto line = reader.record()) {
    const std::string_view row = line->rest();
    const bool is_heading = std::exchange(first, false) && row == heading;
    if (is_heading) continue;
    const std::size_t comma = row.rfind(',');
    if (comma == std::string_view::npos) fail_in(line->where(), "'{}' is not {}", row, heading);
    const std::string name(trimmed(row.substr(0, comma)));
    const std::string_view word = trimmed(row.substr(comma + 1));
    const auto number = parse_finite<double>(word);
    if (name.empty()) fail_in(line->where(), "the name is missing");
    if (!number) fail_in(line->where(), "{}: '{}' is not a valid number", column, word);
    if (!numbers.emplace(name, *number).second)
      fail_in(line->where(), "the photograph '{}' occurs twice", name);
  }
  if (numbers.empty()) fail_in(file, "contains no photograph");
  return numbers;
}

}  // namespace axial::io
