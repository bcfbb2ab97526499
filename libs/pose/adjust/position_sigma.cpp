// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/position_sigma.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pose/bundle/known.h"
#include "scene/robust_similarity.h"

namespace axial::pose {
namespace {

constexpr double kLargestInSigmas = 3;  // distances above count as this

// The indices of the positions whose images have observations.
std::vector<std::size_t> observed_positions(const Bundle& bundle,
                                            const std::vector<KnownPosition>& positions) {
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  std::vector<std::size_t> observed;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (counts[positions[i].image] > 0) observed.push_back(i);
  return observed;
}

// The degrees of freedom of `part` of `all` positions, as judge_positions() says.
double freedom(std::size_t part, std::size_t all) {
  const auto n = static_cast<double>(part), of = static_cast<double>(all);
  return std::max(1.0, 3 * n - 7 * n / of - 1);
}

// The robust standard deviation of coordinates from `distances` of positions, of which there are
// `all`, also those without a distance here.
double sigma_of(const std::vector<double>& distances, std::size_t all) {
  const double free = freedom(distances.size(), all);
  double sigma = std::numeric_limits<double>::infinity();
  constexpr int kSteps = 50;  // the steps only make the result smaller
  for (int step = 0; step < kSteps; ++step) {
    double squares = 0;
    for (const double distance : distances)
      squares += std::pow(std::min(distance, kLargestInSigmas * sigma), 2);
    const double next = std::sqrt(squares / free);
    if (next == sigma) break;
    sigma = next;
  }
  return sigma;
}

}  // namespace

std::vector<std::string> judge_positions(const Bundle& bundle, double factor,
                                         std::vector<KnownPosition>& positions) {
  const std::vector<std::size_t> observed = observed_positions(bundle, positions);
  if (observed.size() < 3) return {};
  std::vector<KnownPosition> known;
  std::vector<std::string> names;
  for (const std::size_t i : observed) {
    known.push_back(positions[i]);
    names.push_back(bundle.images[positions[i].image].name);
  }
  const auto [centres, places] = centres_and_positions(bundle, known);
  const RobustSimilarity fit = robust_similarity(centres, places);
  std::vector<double> distances;
  for (std::size_t k = 0; k < known.size(); ++k)
    if (known[k].sigma_is_guess && !std::ranges::binary_search(fit.outliers, k))
      distances.push_back(fit.distances[k]);
  if (!distances.empty()) {
    const double sigma = std::max(kLeastPositionSigma,
                                  factor * sigma_of(distances, known.size() - fit.outliers.size()));
    for (KnownPosition& one : positions)
      if (one.sigma_is_guess) one.sigma.setConstant(sigma);
  }
  for (std::size_t k = fit.outliers.size(); k-- > 0;)
    positions.erase(positions.begin() + static_cast<std::ptrdiff_t>(observed[fit.outliers[k]]));
  return outlier_lines(fit, names);
}

PositionDistances position_distances(const Bundle& bundle,
                                     const std::vector<KnownPosition>& positions) {
  PositionDistances result;
  double squares = 0, of_stated = 0;
  std::size_t stated = 0;
  for (const std::size_t i : observed_positions(bundle, positions)) {
    const KnownPosition& known = positions[i];
    const Eigen::Vector3d off = bundle.images[known.image].pose.centre - known.metres;
    squares += off.squaredNorm();
    ++result.count;
    if (known.sigma_is_guess) continue;
    of_stated += off.cwiseQuotient(known.sigma).squaredNorm();
    ++stated;
  }
  if (result.count > 0) result.rms = std::sqrt(squares / static_cast<double>(result.count));
  if (stated > 0) result.of_stated = std::sqrt(of_stated / freedom(stated, result.count));
  return result;
}

void correct_contradicted(const PositionDistances& distances,
                          std::vector<KnownPosition>& positions) {
  if (!(distances.of_stated > kContradicted)) return;
  for (KnownPosition& known : positions)
    if (!known.sigma_is_guess) known.sigma *= distances.of_stated;
}

}  // namespace axial::pose
