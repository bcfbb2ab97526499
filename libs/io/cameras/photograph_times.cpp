// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/photograph_times.h"

#include <utility>

#include "base/atomic_file.h"
#include "private/bytes/text_reader.h"

namespace axial::io {

PhotographTimes read_photograph_times(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  TextReader reader(text, file.string());
  PhotographTimes times;
  bool first = true;
  while (const auto line = reader.record()) {
    const std::string_view row = line->rest();
    const bool header = std::exchange(first, false) && row == "name,seconds";
    if (header) continue;
    const std::size_t comma = row.rfind(',');
    if (comma == std::string_view::npos) fail("{}: '{}' is not NAME,SECONDS", line->where(), row);
    const std::string name(trimmed(row.substr(0, comma)));
    const std::string_view number = trimmed(row.substr(comma + 1));
    const auto seconds = parse_finite<double>(number);
    if (name.empty()) fail("{}: the name is missing", line->where());
    if (!seconds) fail("{}: seconds are '{}', which is not a valid number", line->where(), number);
    if (!times.emplace(name, *seconds).second)
      fail("{}: the photograph '{}' occurs twice", line->where(), name);
  }
  if (times.empty()) fail("{}: contains no photograph", file.string());
  return times;
}

}  // namespace axial::io
