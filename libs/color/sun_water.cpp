// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/sun_water.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/parallel.h"
#include "color/channel.h"

namespace axial::color {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The unknowns: a, log(b / a) and B. From photographs at about the same distance, a veil with any
// rate can be told apart from another level of J only by its small curvature. b is near a, because
// both are losses of the same light: b / a is kept within 1 / 2 and 2, and expected to be 1.
constexpr double kLargestRatio = 0.693, kRatioSigma = 0.35;  // of log(b / a)
// A fit must be better by this share of its cost for one standard deviation of log(b / a).
constexpr double kRatioCost = 0.01;

Vector3d within_bounds(const Vector3d& p) {
  return p.cwiseMax(Vector3d(1e-4, -kLargestRatio, 0)).cwiseMin(Vector3d(20, kLargestRatio, 2));
}

double veil_rate(const Vector3d& p) {
  return p[0] * std::exp(p[1]);
}

// The normal equations of the unknowns at a place, after J of each point was eliminated.
struct Normal {
  Matrix3d matrix = Matrix3d::Zero();
  Vector3d gradient = Vector3d::Zero();
  double cost = 0;
  std::vector<double> residuals, factors;
  std::vector<double> surfaces;  // J of each point
  std::vector<Vector3d> slopes;  // of the residuals, besides J
};

// `prior`: the weight of the square of log(b / a).
Normal normal_at(const Channel& channel, const Vector3d& p, double prior) {
  const double b = veil_rate(p);
  Normal normal;
  normal.matrix(1, 1) = prior;
  normal.gradient[1] = prior * p[1];
  normal.cost = prior * p[1] * p[1];
  normal.residuals.resize(channel.light.size());
  normal.factors.resize(channel.light.size());
  normal.slopes.resize(channel.light.size());
  for (std::size_t point = 0; point < channel.points(); ++point) {
    const std::size_t begin = channel.first[point], end = channel.first[point + 1];
    double squares = 0, product = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double way = channel.sights[i].way, direct = std::exp(-p[0] * way);
      const double rest = channel.light[i] - p[2] * (1 - std::exp(-b * way));
      squares += channel.weight[i] * direct * direct;
      product += channel.weight[i] * direct * rest;
    }
    const double surface = product / std::max(squares, 1e-300);
    normal.surfaces.push_back(surface);
    Vector3d shared = Vector3d::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      const double way = channel.sights[i].way, direct = std::exp(-p[0] * way);
      const double scattered = std::exp(-b * way);
      normal.factors[i] = direct;
      normal.residuals[i] = channel.light[i] - p[2] * (1 - scattered) - surface * direct;
      const double by_rate = -p[2] * way * scattered;  // by b
      normal.slopes[i] = {surface * way * direct + by_rate * b / p[0], by_rate * b, scattered - 1};
      shared += channel.weight[i] * direct * normal.slopes[i];
    }
    for (std::size_t i = begin; i < end; ++i) {
      const double direct = std::exp(-p[0] * channel.sights[i].way);
      normal.slopes[i] -= direct / squares * shared;
      const double weight = channel.weight[i], residual = normal.residuals[i];
      normal.matrix += weight * normal.slopes[i] * normal.slopes[i].transpose();
      normal.gradient += weight * residual * normal.slopes[i];
      normal.cost += weight * residual * residual;
    }
  }
  return normal;
}

// The best of a grid of rates, with B by least squares.
Vector3d start_of(const Channel& channel) {
  Vector3d best(0.1, 0, 0);
  double least = std::numeric_limits<double>::max();
  for (const double a : {0.03, 0.08, 0.2, 0.5, 1.2})
    for (const double ratio : {-0.5, 0.0, 0.5}) {
      // The residuals are linear in B.
      const Normal at = normal_at(channel, {a, ratio, 0.05}, 0);
      const double step = at.gradient[2] / std::max(at.matrix(2, 2), 1e-300);
      const Vector3d place = within_bounds({a, ratio, 0.05 - step});
      const double cost = normal_at(channel, place, 0).cost;
      if (cost < least) {
        least = cost;
        best = place;
      }
    }
  return best;
}

// Levenberg and Marquardt's method with the present weights.
Vector3d minimised(const Channel& channel, Vector3d p, double prior) {
  constexpr int kMost = 100;
  double damping = 1e-3;
  Normal at = normal_at(channel, p, prior);
  for (int i = 0; i < kMost; ++i) {
    Matrix3d damped = at.matrix;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12 * at.matrix.trace();
    const Vector3d next = within_bounds(p - damped.ldlt().solve(at.gradient));
    Normal there = normal_at(channel, next, prior);
    if (there.cost < at.cost) {
      const bool done = at.cost - there.cost < 1e-8 * at.cost;
      p = next;
      at = std::move(there);
      damping = std::max(damping / 5, 1e-9);
      if (done) break;
    } else if ((damping *= 6) > 1e6) {
      break;
    }
  }
  return p;
}

// Equations that the unknowns fulfil in the mean, whatever the errors of the observations are: the
// difference of J between two observations of a point is 0. Its slopes contain J, for which the
// mean of the point's *other* observations is taken. In the least squares above, J contains the
// errors of the two, so that the solution is biased unless the ratio of their variances is exactly
// known.
struct Moments {
  Matrix3d matrix = Matrix3d::Zero();
  Vector3d sum = Vector3d::Zero();
  Matrix3d scatter = Matrix3d::Zero();  // of the points' parts of `sum`, and of the views'
  std::size_t points = 0;               // with three or more observations
};

// An observation's J, its precision, and the slopes of J besides those by a through the factor.
struct SurfaceOf {
  double light, precision, way;
  Vector3d slope;
};

SurfaceOf surface_of(const Channel& channel, std::size_t i, const Vector3d& p) {
  const double b = veil_rate(p), way = channel.sights[i].way;
  const double direct = std::exp(-p[0] * way), scattered = std::exp(-b * way);
  const double by_rate = p[2] * way * scattered;  // the veil by b
  return {(channel.light[i] - p[2] * (1 - scattered)) / direct, channel.weight[i] * direct * direct,
          way, -Vector3d(by_rate * b / p[0], by_rate * b, 1 - scattered) / direct};
}

Moments moments_at(const Channel& channel, const Vector3d& p, double prior) {
  Moments moments;
  std::map<std::uint32_t, Vector3d> of_view;
  for (std::size_t point = 0; point < channel.points(); ++point) {
    const std::size_t begin = channel.first[point], count = channel.first[point + 1] - begin;
    if (count < 3) continue;
    std::vector<SurfaceOf> seen;
    double precision = 0, product = 0;
    for (std::size_t i = 0; i < count; ++i) {
      seen.push_back(surface_of(channel, begin + i, p));
      precision += seen[i].precision;
      product += seen[i].precision * seen[i].light;
    }
    Vector3d of_point = Vector3d::Zero();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j) {
        const SurfaceOf &one = seen[i], &two = seen[j];
        const double others = (product - one.precision * one.light - two.precision * two.light) /
                              (precision - one.precision - two.precision);
        Vector3d slope = one.slope - two.slope;
        slope[0] += others * (one.way - two.way);
        const double weight =
            2 / (1 / one.precision + 1 / two.precision) / static_cast<double>(count);
        const Vector3d part = weight * (one.light - two.light) * slope;
        moments.matrix += weight * slope * slope.transpose();
        of_point += part;
        for (const std::size_t k : {i, j})
          of_view.try_emplace(channel.views[begin + k], Vector3d::Zero()).first->second += part / 2;
      }
    moments.sum += of_point;
    moments.scatter += of_point * of_point.transpose();
    ++moments.points;
  }
  for (const auto& [view, part] : of_view) moments.scatter += part * part.transpose();
  moments.matrix(1, 1) += prior;
  moments.sum[1] += prior * p[1];
  return moments;
}

// The fewest points with three observations for which the equations are used.
constexpr std::size_t kLeastMoments = 50;

// Solves the equations from a place near the solution. Returns the place if it does not get nearer.
Vector3d solved(const Channel& channel, const Vector3d& start, double prior) {
  constexpr int kMost = 30;
  Vector3d p = start;
  for (int i = 0; i < kMost; ++i) {
    Moments at = moments_at(channel, p, prior);
    if (at.points < kLeastMoments) return start;
    at.matrix.diagonal().array() += 1e-12 * at.matrix.trace();
    const Vector3d change = at.matrix.ldlt().solve(at.sum);
    if (!change.allFinite()) return start;
    const Vector3d next = within_bounds(p - change);
    const double step = (next - p).norm();
    p = next;
    if (step < 1e-7) return p;
  }
  return p;
}

// The covariance of the unknowns: by the scatter of points and of photographs, with that of the
// prior. With too few points for the equations it is that of least squares, for residuals with the
// standard deviation `scale`.
Matrix3d covariance_of(const Channel& channel, const Vector3d& p, double prior, double scale) {
  const auto inverse_of = [](Matrix3d matrix) -> Matrix3d {
    matrix.diagonal().array() += 1e-12 * matrix.trace();
    return matrix.inverse();
  };
  Moments at = moments_at(channel, p, prior);
  if (at.points < kLeastMoments)
    return scale * scale * inverse_of(normal_at(channel, p, prior).matrix);
  at.scatter(1, 1) += prior * prior * kRatioSigma * kRatioSigma;
  const Matrix3d inverse = inverse_of(at.matrix);
  return inverse * at.scatter * inverse;
}

SunChannel fit(Channel channel) {
  constexpr std::size_t kLeastPoints = 10;
  constexpr int kReweighted = 8;
  constexpr double kLargestShare = 0.3;
  SunChannel result;
  if (channel.points() < kLeastPoints) return result;
  Vector3d p = start_of(channel);
  double prior = 0;
  for (int i = 0; i < kReweighted; ++i) {
    prior = kRatioCost * normal_at(channel, p, 0).cost / (kRatioSigma * kRatioSigma);
    p = solved(channel, minimised(channel, p, prior), prior);
    const Normal at = normal_at(channel, p, prior);
    expect(channel, at.factors, at.surfaces);
    result.residual = weigh(channel, at.residuals);
  }
  const Matrix3d covariance = covariance_of(channel, p, prior, result.residual);
  const double b = veil_rate(p);
  const Vector3d of_b(b / p[0], b, 0);  // the derivatives of b
  result.a = {p[0], std::sqrt(covariance(0, 0))};
  result.b = {b, std::sqrt(of_b.dot(covariance * of_b))};
  result.veil = {p[2], std::sqrt(covariance(2, 2))};
  result.determined = result.a.sigma <= kLargestShare * result.a.value;
  return result;
}

}  // namespace

Eigen::Array3f SunWater::factor(const Sight& sight) const {
  Eigen::Array3f factor;
  for (int k = 0; k < 3; ++k)
    factor[k] =
        std::exp(-static_cast<float>(channels[static_cast<std::size_t>(k)].a.value) * sight.way);
  return factor;
}

Eigen::Array3f SunWater::veil(const Sight& sight) const {
  Eigen::Array3f veil;
  for (int k = 0; k < 3; ++k) {
    const SunChannel& channel = channels[static_cast<std::size_t>(k)];
    veil[k] = static_cast<float>(channel.veil.value * (1 - std::exp(-channel.b.value * sight.way)));
  }
  return veil;
}

SunWater fit_sun(const Observations& observations, const Transfer& transfer) {
  SunWater water;
  parallel_for(3, [&](std::size_t k) {
    water.channels[k] = fit(channel_of(observations, static_cast<int>(k), transfer));
  });
  return water;
}

}  // namespace axial::color
