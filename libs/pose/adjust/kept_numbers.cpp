// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/kept_numbers.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pose/adjust/uncertainty.h"

namespace axial::pose {
namespace {

constexpr double kContradiction = 6;  // of the cost, in squared standard deviations

// How much the cost grows if the numbers `kept` go back to their measured values.
double cost_of(const std::vector<std::size_t>& kept, const NumbersCovariance& numbers,
               const Eigen::VectorXd& changes) {
  const std::vector<Eigen::Index> rows(kept.begin(), kept.end());
  const Eigen::MatrixXd covariance = numbers.covariance(rows, rows);
  const Eigen::VectorXd sigmas = covariance.diagonal().cwiseSqrt();
  // Numbers have different units.
  const Eigen::VectorXd scaled = changes(rows).cwiseQuotient(sigmas);
  const Eigen::MatrixXd correlation =
      sigmas.cwiseInverse().asDiagonal() * covariance * sigmas.cwiseInverse().asDiagonal();
  const double cost = scaled.dot(correlation.ldlt().solve(scaled));
  return std::isfinite(cost) && cost >= 0 ? cost : std::numeric_limits<double>::infinity();
}

struct Step {
  std::size_t number = 0;
  double cost = 0;  // with this number and those kept before
};

std::optional<Step> next_number(const std::vector<std::size_t>& kept,
                                const NumbersCovariance& numbers, const Eigen::VectorXd& changes) {
  std::optional<Step> best;
  for (std::size_t i = 0; i < numbers.numbers.size(); ++i) {
    if (std::ranges::find(kept, i) != kept.end()) continue;
    std::vector<std::size_t> more = kept;
    more.push_back(i);
    const double cost = cost_of(more, numbers, changes);
    if (!best || cost < best->cost) best = Step{i, cost};
  }
  return best;
}

}  // namespace

std::vector<std::size_t> numbers_to_keep(const NumbersCovariance& numbers,
                                         const Eigen::VectorXd& changes) {
  std::vector<std::size_t> kept;
  double cost = 0;
  while (const auto next = next_number(kept, numbers, changes)) {
    if (!(next->cost - cost <= kContradiction)) break;
    kept.push_back(next->number);
    cost = next->cost;
  }
  std::ranges::sort(kept);
  return kept;
}

std::vector<std::array<bool, kHousingNumbers>> numbers_to_keep(const Bundle& bundle,
                                                               const AdjustOptions& options) {
  const NumbersCovariance numbers = covariance_of_numbers(bundle, options);
  Eigen::VectorXd changes(static_cast<Eigen::Index>(numbers.numbers.size()));
  for (std::size_t i = 0; i < numbers.numbers.size(); ++i) {
    const auto [camera, index] = numbers.numbers[i];
    const BundleCamera& of = bundle.cameras[camera];
    const bool measured = options.sigma_before(of, index) > 0;
    changes(static_cast<Eigen::Index>(i)) =
        measured ? of.change(index) : std::numeric_limits<double>::infinity();
  }
  std::vector<std::array<bool, kHousingNumbers>> kept(bundle.cameras.size());
  for (const std::size_t i : numbers_to_keep(numbers, changes)) {
    const auto [camera, index] = numbers.numbers[i];
    kept[camera][static_cast<std::size_t>(index)] = true;
  }
  return kept;
}

}  // namespace axial::pose
