// SPDX-License-Identifier: GPL-3.0-or-later
// Values at a place in the order of their sizes, such as the median. No value may be NaN.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace axial {

// The value with the index `place` among the values in ascending order. Precondition: there are
// more than `place` values.
template <class T>
T value_at_place(std::vector<T> values, std::size_t place) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The largest value that is not above the share `share` (0 to 1) of the way through the values in
// ascending order: at the index share * (number - 1), rounded down. 0 if there are no values.
template <class T>
T lower_quantile(std::vector<T> values, double share) {
  if (values.empty()) return T{};
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  return value_at_place(std::move(values), place);
}

// The median; of an even number of values, the upper one of the two in the middle. 0 if there are
// no values.
template <class T>
T upper_median(std::vector<T> values) {
  if (values.empty()) return T{};
  const std::size_t middle = values.size() / 2;
  return value_at_place(std::move(values), middle);
}

}  // namespace axial
