// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "cameras/private/position_parts.h"
#include "io/cameras/image_positions.h"
#include "scene/robust_similarity.h"

namespace axial::io {
namespace {

constexpr std::size_t kFew = 6;  // fewer images fit a wrong reading by chance

// A reading of the positions and how well it fits the cameras.
struct Candidate {
  std::optional<std::size_t> as_degrees;
  std::string unit;
  double misfit = 1;  // RMS of the residuals as a part of the RMS extent, at most 1
};

Eigen::Matrix3Xd columns_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Matrix3Xd columns(3, points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    columns.col(static_cast<Eigen::Index>(k)) = points[k] - points[0];
  return columns;
}

double misfit_of(const Eigen::Matrix3Xd& centres, const Eigen::Matrix3Xd& positions) {
  constexpr double kExact = 1e-6;  // smaller residuals come from rounding
  const Eigen::Matrix3Xd centred = positions.colwise() - positions.rowwise().mean();
  if (!((centres.colwise() - centres.col(0)).squaredNorm() > 0)) return 1;
  const double extent = std::sqrt(centred.squaredNorm() / static_cast<double>(positions.cols()));
  const double misfit = robust_similarity(centres, positions).rms / extent;
  return std::isfinite(misfit) ? std::clamp(misfit, kExact, 1.0) : 1;
}

std::vector<Candidate> candidates_of(const PositionFile& read, std::span<const std::size_t> rows,
                                     std::span<const Eigen::Vector3d> centres) {
  const Eigen::Matrix3Xd from = columns_of(centres);
  std::vector<Eigen::Vector3d> to;
  for (const std::size_t row : rows) to.push_back(read.positions[row].position);
  std::vector<Candidate> candidates{{{}, "metres", misfit_of(from, columns_of(to))}};
  for (std::size_t i = 0; i < read.as_degrees.size(); ++i) {
    for (std::size_t k = 0; k < rows.size(); ++k) to[k] = read.as_degrees[i].positions[rows[k]];
    candidates.push_back({i, read.as_degrees[i].unit, misfit_of(from, columns_of(to))});
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::misfit);
  return candidates;
}

}  // namespace

ChosenUnit choose_unit(const PositionFile& read, std::span<const std::size_t> rows,
                       std::span<const Eigen::Vector3d> centres, const std::string& file) {
  if (rows.size() < 3) return {};
  const double clear = rows.size() < kFew ? 0.1 : 0.5;
  const std::vector<Candidate> candidates = candidates_of(read, rows, centres);
  const Candidate &best = candidates[0], &second = candidates[1];
  const std::string fits =
      fmt::format("residuals of {:.2g} % of the extent as {}, {:.2g} % as {}", 100 * best.misfit,
                  best.unit, 100 * second.misfit, second.unit);
  if (best.misfit <= clear * second.misfit)
    return {best.as_degrees,
            fmt::format("no line states the unit of the positions; they fit the cameras as {} ({})",
                        best.unit, fits)};
  if (best.as_degrees && second.as_degrees && best.misfit <= clear * candidates[2].misfit)
    throw UnclearUnit(fmt::format("{}: {}", file, kUnknownOrder), file);
  const std::string text = fmt::format(
      "{}: no line states whether the positions are metres or degrees, and they fit the cameras "
      "about equally well ({}); name the columns in a first line such as label,x (m),y (m),z (m) "
      "or label,longitude,latitude,altitude",
      file, fits);
  throw UnclearUnit(text, file);
}

}  // namespace axial::io
