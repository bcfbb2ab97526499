// SPDX-License-Identifier: GPL-3.0-or-later
#include "free_numbers.h"

#include <algorithm>
#include <numbers>
#include <set>
#include <sstream>

#include "base/error.h"

namespace {

using namespace axial;
using Words = std::set<std::string>;

Words words_of(const std::string& list) {
  const Words known{"normal", "distance", "centre", "index", "focal"};
  Words words;
  std::istringstream in(list);
  for (std::string word; std::getline(in, word, ',');) {
    if (word == "center") word = "centre";
    if (!known.contains(word))
      fail("--refine {}: '{}' is none of normal, distance, centre, index, focal", list, word);
    words.insert(word);
  }
  return words;
}

template <class Kind>
bool any_behind(const pose::Bundle& bundle) {
  return std::ranges::any_of(bundle.cameras, [](const pose::BundleCamera& camera) {
    return camera.measured.port && std::holds_alternative<Kind>(*camera.measured.port);
  });
}

void check_ports(const std::string& refine, const Words& words, const pose::Bundle& bundle) {
  const bool of_flat = words.contains("normal") || words.contains("distance");
  if (of_flat && words.contains("centre"))
    fail("--refine {}: a flat port has no centre, and a dome only that", refine);
  if (of_flat && any_behind<refractive::DomePort<double>>(bundle))
    fail("--refine {}: there is a dome, which has a centre instead", refine);
  if (words.contains("centre") && any_behind<refractive::FlatPort<double>>(bundle))
    fail("--refine {}: there is a flat port, which has a normal and a distance instead", refine);
}

void set(const Words& words, const std::string& word, double sigma, double scale,
         std::initializer_list<std::size_t> numbers, pose::AdjustOptions& adjust) {
  if (sigma > 0 && !words.contains(word))
    fail("--{}-sigma {}: --refine does not name {}", word, sigma, word);
  if (!words.contains(word)) return;
  for (const std::size_t number : numbers) {
    adjust.free[number] = true;
    adjust.prior_sigma[number] = sigma * scale;
  }
}

}  // namespace

void set_free_numbers(const std::string& refine, const Sigmas& sigmas, const pose::Bundle& bundle,
                      pose::AdjustOptions& adjust) {
  const Words words = words_of(refine);
  check_ports(refine, words, bundle);
  if (words.contains("distance") && !(sigmas.distance > 0) && adjust.distances.empty() &&
      adjust.positions.empty())
    fail(
        "--refine {}: the distance needs --distance-sigma or --scale-from, since the photographs "
        "show only its ratio to other lengths",
        refine);
  set(words, "normal", sigmas.normal_degrees, std::numbers::pi / 180, {0, 1}, adjust);
  set(words, "distance", sigmas.distance, 1, {2}, adjust);
  set(words, "centre", sigmas.centre, 1, {0, 1, 2}, adjust);
  set(words, "index", sigmas.index, 1, {pose::kIndexNumber}, adjust);
  set(words, "focal", sigmas.focal, 1, {pose::kFocalNumber}, adjust);
}
