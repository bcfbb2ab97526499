// SPDX-License-Identifier: GPL-3.0-or-later
// Markdown tables of the depth maps' errors, and helpers that combine numbers of several seeds. In
// all functions, `results` are the results of the whole experiment `reconstruction`, in the form
// that Experiment::documents takes, and `seeds` are the seeds of this experiment, at least one. The
// tables compare the methods with Method::judged_closely on true poses. Each number is the median
// over the seeds.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/reconstruction.h"

namespace axial::experiments {

using Seeds = std::vector<int>;

// Returns the median of value(seed) over the seeds.
double median_over(const Seeds& seeds, const std::function<double(int seed)>& value);
// Returns the texts text(seed), in the order of the seeds, separated by ", ".
std::string joined(const Seeds& seeds, const std::function<std::string(int seed)>& text);

// Errors of all pixels of all maps. One row for each method.
std::string maps_table(const Json& results, const Seeds& seeds);

// Errors by the class of a pixel (evaluate/pixel_classes.h). One row for each method and class.
// Errors are "-" if a seed has fewer than 5000 compared pixels in the class.
std::string places_table(const Json& results, const Seeds& seeds);

// Position errors in a source view [1/1000 px], by the fractional part of the true position
// (evaluate::PhaseErrors). One row for each bin, one column for each method.
std::string phases_table(const Json& results, const Seeds& seeds);

// Medians of the relative error (estimate - truth) / truth in rings around the image centre
// [1/10000], and their differences from those in air. One row for each ring. Two columns give the
// differences of each seed instead of their median. Rings with few pixels have no numbers (see
// largest_ring_difference()).
std::string rings_table(const Json& results, const Seeds& seeds);

// Compares our method under water with the images in air, ring by ring. Let m be the median of the
// relative error (estimate - truth) / truth in a ring. Let d be the median, over the seeds, of the
// difference between m of our method and m in air. Returns the largest |d| over the rings; 0 if no
// ring counts. A ring does not count if a seed has fewer than 5000 pixels of a method in it.
double largest_ring_difference(const Json& results, const Seeds& seeds);

}  // namespace axial::experiments
