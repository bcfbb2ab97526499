// SPDX-License-Identifier: GPL-3.0-or-later
// How known lengths and places fit the adjusted bundle, and which of them are wrong.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "pose/bundle/adjust_options.h"

namespace axial::pose {

// A number of the bundle beside its known value.
struct KnownFit {
  double known = 0, present = 0;  // [m]
  double known_sigma = 0;         // standard deviation of `known`
  double present_sigma = 0;       // standard deviation of `present`
  // The standard deviation of the difference: the two sigmas are independent for a check, and
  // `known` is a part of `present` otherwise. At least a fifth of `known_sigma`. Infinite: the used
  // places do not determine `present` of a check, so that the difference means nothing.
  double expected = 0;

  double off() const { return present - known; }
  // The difference from the value that all other knowledge gives. Not for checks.
  double off_from_others() const { return off() * std::pow(known_sigma / expected, 2); }
  // The difference in its standard deviations.
  double deviation() const { return off() / expected; }
};

// A coordinate that is not known has the `known_sigma` infinity, and a deviation of 0.
struct PlaceFit {
  std::array<KnownFit, 3> coordinates;
};

struct ControlFits {
  std::vector<KnownFit> distances;  // in the order of the arguments
  std::vector<PlaceFit> places;
};

// The fits of `distances` and `places`, whose points are targets. `used`: they are among those of
// `options`, with which the bundle was adjusted; otherwise they are checks. Error if a point is not
// in the bundle.
ControlFits control_fits(const Bundle& bundle, const AdjustOptions& options,
                         std::span<const KnownDistance> distances,
                         std::span<const KnownPlace> places, bool used);

// The next functions remove known lengths and places with names from `options`, and return a line
// for each.

// Removes those whose points or images have no observations in the bundle.
std::vector<std::string> leave_out_lost(const Bundle& bundle, AdjustOptions& options);

// Removes wholly known places that do not fit the similarity of the others (robust_similarity()),
// if there are at least four. If two of them fit each other's place, the line says that their
// labels are exchanged. Removes lengths that differ by more than 30 % from the scale of most
// lengths; of two such lengths, both.
std::vector<std::string> leave_out_outliers(const Bundle& bundle, AdjustOptions& options);

// Removes the wrong length or place, and adds a line to `lines`. Values with deviations (KnownFit)
// above 4 are suspects. The wrong one is the suspect without which the adjusted bundle has the
// smallest cost, of at most four. Two values contradict each other if nothing else controls the
// second without the first, and if the cost without either is nearly the same: nothing tells which
// of them is wrong, and both stay. Returns whether a value was removed; the bundle must then be
// adjusted again.
bool leave_out_worst(const Bundle& bundle, AdjustOptions& options, std::vector<std::string>& lines,
                     const Context& context = {});

// A line for each pair of values that contradict each other.
std::vector<std::string> contradictions(const Bundle& bundle, const AdjustOptions& options,
                                        const Context& context = {});

}  // namespace axial::pose
