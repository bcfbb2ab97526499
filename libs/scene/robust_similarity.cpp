// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/robust_similarity.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "base/order_statistics.h"

namespace axial {
namespace {

using Indices = std::vector<std::size_t>;

constexpr std::size_t kAllTriples = 24, kRandomTriples = 500;

Eigen::Matrix3Xd columns_of(const Eigen::Matrix3Xd& points, const Indices& indices) {
  Eigen::Matrix3Xd part(3, static_cast<Eigen::Index>(indices.size()));
  for (std::size_t k = 0; k < indices.size(); ++k)
    part.col(static_cast<Eigen::Index>(k)) = points.col(static_cast<Eigen::Index>(indices[k]));
  return part;
}

// Points and their partners.
class Pairs {
 public:
  Pairs(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to, bool with_scale)
      : from_(from), to_(to), with_scale_(with_scale) {}

  std::size_t count() const { return static_cast<std::size_t>(from_.cols()); }
  Similarity fit() const { return best_similarity(from_, to_, with_scale_); }
  Similarity fit(const Indices& part) const {
    return best_similarity(columns_of(from_, part), columns_of(to_, part), with_scale_);
  }
  std::vector<double> distances(const Similarity& similarity) const {
    std::vector<double> distances(count());
    for (std::size_t i = 0; i < count(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      distances[i] = (similarity(from_.col(column)) - to_.col(column)).norm();
    }
    return distances;
  }
  Eigen::Matrix3Xd sources(const Indices& part) const { return columns_of(from_, part); }
  Eigen::Matrix3Xd targets(const Indices& part) const { return columns_of(to_, part); }
  bool on_line(const Indices& part) const {
    return !(relative_width(sources(part)) > kLineWidth) ||
           !(relative_width(targets(part)) > kLineWidth);
  }
  const Eigen::Matrix3Xd& from() const { return from_; }
  int unknowns() const { return with_scale_ ? 7 : 6; }
  const Eigen::Matrix3Xd& to() const { return to_; }

 private:
  const Eigen::Matrix3Xd& from_;
  const Eigen::Matrix3Xd& to_;
  bool with_scale_;
};

// How many points must fit: more than half, and one fewer than all, so that one can be wrong.
std::size_t majority(std::size_t count) {
  return std::min(count - 1, (count + 4) / 2);
}

// Calls `visit` with triples of different indices below `count`.
template <class Visit>
void for_triples(std::size_t count, const Visit& visit) {
  if (count <= kAllTriples) {
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j)
        for (std::size_t k = j + 1; k < count; ++k) visit(Indices{i, j, k});
    return;
  }
  std::uint64_t state = 1;  // of a linear congruential generator (D. Knuth, MMIX)
  const auto next = [&] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>((state >> 33) % count);
  };
  for (std::size_t triple = 0; triple < kRandomTriples; ++triple) {
    const std::size_t i = next();
    std::size_t j = next(), k = next();
    while (j == i) j = next();
    while (k == i || k == j) k = next();
    visit(Indices{i, j, k});
  }
}

// The `number` points with the smallest distances, in ascending order.
Indices nearest(const std::vector<double>& distances, std::size_t number) {
  Indices order(distances.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return distances[i]; });
  order.resize(number);
  std::ranges::sort(order);
  return order;
}

// The points that fit best together, `number` of them.
Indices best_part(const Pairs& pairs, std::size_t number) {
  double least = std::numeric_limits<double>::infinity();
  Similarity best;
  for_triples(pairs.count(), [&](const Indices& triple) {
    if (pairs.on_line(triple)) return;
    const Similarity trial = pairs.fit(triple);
    const double farthest = value_at_place(pairs.distances(trial), number - 1);
    if (farthest < least) least = farthest, best = trial;
  });
  if (!std::isfinite(least)) return {};
  Indices part = nearest(pairs.distances(best), number);
  for (int step = 0; step < 50 && !pairs.on_line(part); ++step) {
    Indices next = nearest(pairs.distances(pairs.fit(part)), number);
    if (next == part) break;
    part = std::move(next);
  }
  return part;
}

double limit_in_sigmas(std::size_t fitting) {
  if (fitting <= 3) return 200;
  if (fitting == 4) return 30;
  return fitting < 8 ? 15 : 10;
}

// The distances up to which points fit the points `part`.
class Limits {
 public:
  Limits(const Pairs& pairs, const Indices& part, const std::vector<double>& distances) {
    const Eigen::Matrix3Xd places = pairs.targets(part);
    mean_ = places.rowwise().mean();
    const Eigen::Matrix3Xd centred = places.colwise() - mean_;
    const SymmetricEigen3 moments(Eigen::Matrix3d(centred * centred.transpose()));
    // A turn about the longest axis is the least certain: the second moment determines it. About a
    // line every turn is allowed.
    line_ = moments.eigenvectors().col(2);
    second_moment_ = moments.eigenvalues()(pairs.on_line(part) ? 2 : 1);
    count_ = static_cast<double>(part.size());
    extent_ = std::sqrt(moments.eigenvalues()(2) / count_);
    double squares = 0;
    for (const std::size_t i : part) squares += distances[i] * distances[i];
    const int freedom = 3 * static_cast<int>(part.size()) - pairs.unknowns();
    sigma_ = std::max(std::sqrt(squares / freedom), 1e-9 * extent_);
    sigmas_ = limit_in_sigmas(part.size());
  }

  double at(const Eigen::Vector3d& place) const {
    const double uncertainty = 1 / count_ + (place - mean_).squaredNorm() / second_moment_;
    return std::max(sigmas_ * sigma_ * std::sqrt(1 + uncertainty), 1e-4 * extent_);
  }

  // The place along the longest axis of the points, and the distance from this axis.
  Eigen::Vector2d along_line(const Eigen::Vector3d& place) const {
    const double along = line_.dot(place - mean_);
    return {along, (place - mean_ - along * line_).norm()};
  }

 private:
  Eigen::Vector3d mean_, line_;
  double second_moment_ = 0, count_ = 0, extent_ = 0, sigma_ = 0, sigmas_ = 0;
};

// All points that fit the points `part`.
Indices fitting(const Pairs& pairs, const Indices& part) {
  const std::vector<double> distances = pairs.distances(pairs.fit(part));
  const Limits limits(pairs, part, distances);
  Indices result;
  for (std::size_t i = 0; i < pairs.count(); ++i)
    if (distances[i] <= limits.at(pairs.to().col(static_cast<Eigen::Index>(i))))
      result.push_back(i);
  return result;
}

// The points that fit together; all if no majority of them determines a similarity.
Indices inliers_of(const Pairs& pairs) {
  Indices all(pairs.count());
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (pairs.count() < 4) return all;
  const std::size_t least = majority(pairs.count());
  Indices part = best_part(pairs, least);
  for (int step = 0; step < 50; ++step) {
    if (part.size() < least || pairs.on_line(part)) return all;
    Indices next = fitting(pairs, part);
    if (next == part) return part;
    part = std::move(next);
  }
  return all;  // no stable division
}

// The index of the one point without which the others are on a line.
std::optional<std::size_t> alone_off_line(const Eigen::Matrix3Xd& points) {
  const double count = static_cast<double>(points.cols());
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::Matrix3d all = centred * centred.transpose();
  std::optional<std::size_t> alone;
  double least = kLineWidth;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Matrix3d others =
        all - count / (count - 1) * centred.col(i) * centred.col(i).transpose();
    const Eigen::Vector3d moments =
        SymmetricEigen3(others, Eigen::EigenvaluesOnly).eigenvalues().cwiseMax(0);
    const double width = std::sqrt(moments(1) / moments(2));
    if (width < least) least = width, alone = static_cast<std::size_t>(i);
  }
  return alone;
}

// The point of `part` that does not fit the others, wherever they turn about the line on which they
// are.
std::optional<std::size_t> misfit_off_line(const Pairs& pairs, const Indices& part) {
  if (part.size() < 4) return {};
  for (const Eigen::Matrix3Xd& points : {pairs.sources(part), pairs.targets(part)}) {
    const std::optional<std::size_t> alone = alone_off_line(points);
    if (!alone) continue;
    const std::size_t point = part[*alone];
    Indices others = part;
    std::erase(others, point);
    if (!pairs.on_line(others)) continue;
    const Similarity fit = pairs.fit(others);
    const Limits limits(pairs, others, pairs.distances(fit));
    const auto column = static_cast<Eigen::Index>(point);
    const Eigen::Vector3d moved = fit(pairs.from().col(column)), target = pairs.to().col(column);
    if ((limits.along_line(moved) - limits.along_line(target)).norm() > limits.at(target))
      return point;
  }
  return {};
}

double rms_of(const std::vector<double>& distances, const Indices& part) {
  double squares = 0;
  for (const std::size_t i : part) squares += distances[i] * distances[i];
  return std::sqrt(squares / static_cast<double>(part.size()));
}

}  // namespace

RobustSimilarity robust_similarity(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                                   bool with_scale) {
  const Pairs pairs(from, to, with_scale);
  const Indices inliers = inliers_of(pairs);
  RobustSimilarity result;
  result.similarity = inliers.size() == pairs.count() ? pairs.fit() : pairs.fit(inliers);
  result.distances = pairs.distances(result.similarity);
  result.rms = rms_of(result.distances, inliers);
  result.off_line = misfit_off_line(pairs, inliers);
  for (std::size_t i = 0; i < pairs.count(); ++i)
    if (!std::ranges::binary_search(inliers, i)) result.outliers.push_back(i);
  return result;
}

MirroredFit mirrored_fit(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                         bool with_scale) {
  const Eigen::Matrix3Xd mirrored = Eigen::Vector3d(1, 1, -1).asDiagonal() * from;
  const Pairs proper(from, to, with_scale), improper(mirrored, to, with_scale);
  const Indices part = inliers_of(improper);
  MirroredFit fit;
  fit.mirrored_rms = rms_of(improper.distances(improper.fit(part)), part);
  fit.rms = rms_of(proper.distances(proper.fit(part)), part);
  const Eigen::Matrix3Xd places = improper.targets(part);
  const double extent = (places.colwise() - places.rowwise().mean()).colwise().norm().maxCoeff();
  const double factor = part.size() < 6 ? 20 : 5;
  fit.better = fit.rms > factor * fit.mirrored_rms && fit.rms > 1e-6 * extent;
  fit.alike = !fit.better && fit.mirrored_rms < 1.5 * fit.rms + 1e-6 * extent;
  return fit;
}

std::string off_line_sentence(const RobustSimilarity& fit, const std::string& name) {
  return fmt::format(
      "the position of {} does not fit the {} others that are used, and these lie on one line, "
      "about which the rotation of the cameras is not determined",
      name, fit.distances.size() - fit.outliers.size() - 1);
}

std::string mirrored_line(const MirroredFit& fit) {
  return fmt::format(
      "the positions fit the mirror image of the cameras {:.3g} times better than the cameras (RMS "
      "{:.4g} m instead of {:.4g} m): {}",
      fit.rms / std::max(fit.mirrored_rms, 1e-9 * fit.rms), fit.mirrored_rms, fit.rms,
      kCausesOfMirror);
}

std::vector<std::string> outlier_lines(const RobustSimilarity& fit,
                                       std::span<const std::string> names) {
  constexpr std::size_t kTold = 5;
  std::vector<std::string> lines;
  const std::size_t fitting = fit.distances.size() - fit.outliers.size();
  for (const std::size_t i : fit.outliers) {
    if (lines.size() == kTold) {
      lines.push_back(fmt::format("{} more positions do not fit and are not used",
                                  fit.outliers.size() - kTold));
      break;
    }
    lines.push_back(
        fmt::format("the position of {} is {:.4g} m from where the {} positions that fit together "
                    "put it, and is "
                    "not used",
                    names[i], fit.distances[i], fitting));
  }
  return lines;
}

}  // namespace axial
