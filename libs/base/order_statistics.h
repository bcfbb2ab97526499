// SPDX-License-Identifier: GPL-3.0-or-later
// Values at a place in the order of their sizes, such as the median. No value may be NaN.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
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

// The same as upper_median() without a copy. The values get another order.
template <class T>
T upper_median_of_moved(std::vector<T>& values) {
  if (values.empty()) return T{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The median; of an even number of values, the upper one of the two in the middle. 0 if there are
// no values.
template <class T>
T upper_median(std::vector<T> values) {
  return upper_median_of_moved(values);
}

// The quantile at `share` (0 to 1) of the way through values in ascending order, interpolated
// linearly between the two values beside it. 0 if there are no values.
template <class T>
double interpolated_quantile(std::span<const T> sorted, double share) {
  if (sorted.empty()) return 0;
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double part = at - static_cast<double>(below);
  return (1 - part) * static_cast<double>(sorted[below]) +
         part * static_cast<double>(sorted[above]);
}

// The median; of an even number of values, the mean of the two in the middle. 0 if there are no
// values.
template <class T>
double mean_median(std::vector<T> values) {
  std::sort(values.begin(), values.end());
  return interpolated_quantile<T>(values, 0.5);
}

// The standard deviation of normally distributed values, divided by the median of the distances
// from their median.
inline constexpr double kSigmasOfMedian = 1.4826;

// The robust standard deviation about zero: kSigmasOfMedian times the upper_median() of the
// absolute values. 0 if there are no values.
inline double deviation_about_zero(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return kSigmasOfMedian * upper_median(std::move(values));
}

// The robust standard deviation: kSigmasOfMedian times the upper_median() of the distances of the
// values from their upper_median(). 0 if there are no values.
inline double robust_deviation(std::vector<double> values) {
  const double median = upper_median(values);
  for (double& value : values) value -= median;
  return deviation_about_zero(std::move(values));
}

}  // namespace axial
