// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/faces/labels.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace axial::texture {
namespace {

// Faces in a ring, with random qualities of random views.
struct Problem {
  FaceViews views;
  std::vector<FacePair> pairs;
};

Problem random_problem(std::uint32_t faces, std::uint32_t views) {
  Problem problem;
  problem.views.begin.push_back(0);
  for (std::uint32_t f = 0; f < faces; ++f) {
    for (std::uint32_t v = 0; v < views; ++v)
      if (*rc::gen::inRange(0, 4) > 0)
        problem.views.sights.push_back(
            {v, static_cast<float>(*rc::gen::inRange(1, 100)), {}, true});
    problem.views.begin.push_back(problem.views.sights.size());
    problem.pairs.push_back({f, (f + 1) % faces, 0, 1});
    if (f + 3 < faces) problem.pairs.push_back({f, f + 3, 0, 1});
  }
  return problem;
}

// The sum that choose_views() minimises; infinite for a view that does not see its face.
double energy(const Problem& problem, std::span<const std::uint32_t> labels, double ratio) {
  double sum = 0;
  for (std::size_t f = 0; f < labels.size(); ++f) {
    const auto sights = problem.views.of(f);
    if (sights.empty() && labels[f] == kNoView) continue;
    float best = 0, own = -1;
    for (const Sight& sight : sights) {
      best = std::max(best, sight.quality);
      if (sight.view == labels[f]) own = sight.quality;
    }
    if (own < 0) return std::numeric_limits<double>::infinity();
    sum += 2 * ratio * (1 - own / best);
  }
  for (const FacePair& p : problem.pairs)
    if (labels[p.a] != labels[p.b] && labels[p.a] != kNoView && labels[p.b] != kNoView) sum += 1;
  return sum;
}

// The least energy of all labellings.
double least_energy(const Problem& problem, std::uint32_t views, double ratio) {
  const std::size_t faces = problem.views.faces();
  std::vector<std::uint32_t> labels(faces, 0);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0;; ++k) {
    std::size_t rest = k;
    for (std::size_t f = 0; f < faces; ++f) {
      labels[f] = problem.views.of(f).empty() ? kNoView : static_cast<std::uint32_t>(rest % views);
      rest /= views;
    }
    if (rest > 0) return least;
    least = std::min(least, energy(problem, labels, ratio));
  }
}

constexpr double kRounding = 0.01;  // costs are rounded to thousandths

// With two views an expansion is a minimum cut of the whole problem, and so exact.
RC_GTEST_PROP(Labels, TwoViewsAreChosenOptimally, ()) {
  const Problem problem = random_problem(8, 2);
  const double ratio = *rc::gen::element(0.1, 0.5, 2.0);
  const auto labels = choose_views(problem.views, problem.pairs, {ratio, 10});
  RC_ASSERT(energy(problem, labels, ratio) <= least_energy(problem, 2, ratio) + kRounding);
}

// Alpha expansion of Potts costs is at most twice the optimum.
RC_GTEST_PROP(Labels, ThreeViewsAreChosenWell, ()) {
  const Problem problem = random_problem(6, 3);
  const double ratio = *rc::gen::element(0.1, 0.5, 2.0);
  const auto labels = choose_views(problem.views, problem.pairs, {ratio, 10});
  RC_ASSERT(energy(problem, labels, ratio) <= 2 * least_energy(problem, 3, ratio) + kRounding);
}

}  // namespace
}  // namespace axial::texture
