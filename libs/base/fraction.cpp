// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/fraction.h"

#include "base/error.h"
#include "base/parse_number.h"
#include "base/split.h"

namespace axial {

Fraction parse_fraction(const std::string& option, const std::string& value, std::size_t most) {
  const auto words = split(value, '/');
  const auto part = words.size() == 2 ? parse_number<std::size_t>(words[0]) : std::nullopt;
  const auto count = words.size() == 2 ? parse_number<std::size_t>(words[1]) : std::nullopt;
  if (!part || !count || *count < 1 || *count > most || *part < 1 || *part > *count)
    fail("{} {}: must be I/N with I from 1 to N, and N from 1 to {}", option, value, most);
  return {*part, *count};
}

}  // namespace axial
