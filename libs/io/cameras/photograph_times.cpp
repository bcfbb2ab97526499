// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/photograph_times.h"

#include <utility>

#include "base/atomic_file.h"
#include "bytes/private/text_reader.h"

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
    if (comma == std::string_view::npos) fail_in(line->where(), "'{}' is not NAME,SECONDS", row);
    const std::string name(trimmed(row.substr(0, comma)));
    const std::string_view number = trimmed(row.substr(comma + 1));
    const auto seconds = parse_finite<double>(number);
    if (name.empty()) fail_in(line->where(), "the name is missing");
    if (!seconds) fail_in(line->where(), "seconds are '{}', which is not a valid number", number);
    if (!times.emplace(name, *seconds).second)
      fail_in(line->where(), "the photograph '{}' occurs twice", name);
  }
  if (times.empty()) fail_in(file, "contains no photograph");
  return times;
}

}  // namespace axial::io
