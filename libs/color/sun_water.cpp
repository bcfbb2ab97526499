// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/sun_water.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "base/parallel.h"
#include "color/channel.h"

namespace axial::color {
namespace {

// The unknowns: a, log(b / a), B and the three numbers of SunChannel::veil_by_direction. From
// photographs at about the same distance, a veil with any rate can be told apart from another level
// of J only by its small curvature. b is near a, because both are losses of the same light: b / a
// is kept within 1 / 2 and 2, and expected to be 1. The veil is expected to be even.
constexpr int kUnknowns = 6;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Vector = Eigen::Vector<double, kUnknowns>;
constexpr double kLargestRatio = 0.693;  // of log(b / a)
// A fit must be better by kPriorCost of its cost for one standard deviation.
constexpr std::array<double, kUnknowns> kPriorSigmas{0, 0.35, 0, 1, 1, 1};  // 0: no prior
constexpr double kPriorCost = 0.01;

Vector within_bounds(const Vector& p) {
  constexpr double kSteepest = 4;
  Vector within = p.cwiseMax(-kSteepest).cwiseMin(kSteepest);
  within[0] = std::clamp(p[0], 1e-4, 20.0);
  within[1] = std::clamp(p[1], -kLargestRatio, kLargestRatio);
  within[2] = std::clamp(p[2], 0.0, 2.0);
  return within;
}

double veil_rate(const Vector& p) {
  return p[0] * std::exp(p[1]);
}

// I = J direct + veil for a sight, whose direction is relative to SunWater::middle.
struct Terms {
  double direct, veil;
  Vector slopes;  // of the veil
};

Terms terms_of(const Sight& sight, const Vector& p) {
  const double way = sight.way, b = veil_rate(p), left = std::exp(-b * way);
  const Eigen::Vector3d direction = sight.direction.cast<double>();
  const double growth = std::exp(p.tail<3>().dot(direction));
  Terms terms{std::exp(-p[0] * way), p[2] * growth * (1 - left), Vector::Zero()};
  const double by_rate = p[2] * growth * way * left;
  terms.slopes << by_rate * b / p[0], by_rate * b, growth * (1 - left), terms.veil * direction;
  return terms;
}

// The weights of the squares of the unknowns.
Vector prior_weights(double prior) {
  Vector weights = Vector::Zero();
  for (int k = 0; k < kUnknowns; ++k) {
    const double sigma = kPriorSigmas[static_cast<std::size_t>(k)];
    if (sigma > 0) weights[k] = prior / (sigma * sigma);
  }
  return weights;
}

// The normal equations of the unknowns at a place, after J of each point was eliminated.
struct Normal {
  Matrix matrix = Matrix::Zero();
  Vector gradient = Vector::Zero();
  double cost = 0;
  std::vector<double> residuals, factors;
  std::vector<double> surfaces;  // J of each point
};

// `prior`: the weight of the squares of the unknowns, in standard deviations.
Normal normal_at(const Channel& channel, const Vector& p, double prior) {
  const Vector weights = prior_weights(prior);
  Normal normal;
  normal.matrix = weights.asDiagonal();
  normal.gradient = weights.cwiseProduct(p);
  normal.cost = p.dot(normal.gradient);
  normal.residuals.resize(channel.light.size());
  normal.factors.resize(channel.light.size());
  std::vector<Terms> terms;
  for (std::size_t point = 0; point < channel.points(); ++point) {
    const std::size_t begin = channel.first[point], end = channel.first[point + 1];
    double squares = 0, product = 0;
    terms.clear();
    for (std::size_t i = begin; i < end; ++i) {
      terms.push_back(terms_of(channel.sights[i], p));
      const Terms& at = terms.back();
      squares += channel.weight[i] * at.direct * at.direct;
      product += channel.weight[i] * at.direct * (channel.light[i] - at.veil);
    }
    const double surface = product / std::max(squares, 1e-300);
    normal.surfaces.push_back(surface);
    Vector shared = Vector::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      Terms& at = terms[i - begin];
      normal.factors[i] = at.direct;
      normal.residuals[i] = channel.light[i] - at.veil - surface * at.direct;
      at.slopes = -at.slopes;  // of the residual
      at.slopes[0] += surface * channel.sights[i].way * at.direct;
      shared += channel.weight[i] * at.direct * at.slopes;
    }
    for (std::size_t i = begin; i < end; ++i) {
      const Terms& at = terms[i - begin];
      const Vector slopes = at.slopes - at.direct / std::max(squares, 1e-300) * shared;
      const double weight = channel.weight[i], residual = normal.residuals[i];
      normal.matrix += weight * slopes * slopes.transpose();
      normal.gradient += weight * residual * slopes;
      normal.cost += weight * residual * residual;
    }
  }
  return normal;
}

// Levenberg and Marquardt's method with the present weights.
Vector minimised(const Channel& channel, Vector p, double prior) {
  constexpr int kMost = 100;
  double damping = 1e-3;
  Normal at = normal_at(channel, p, prior);
  for (int i = 0; i < kMost; ++i) {
    Matrix damped = at.matrix;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12 * at.matrix.trace();
    const Vector next = within_bounds(p - damped.ldlt().solve(at.gradient));
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

// With B by least squares, in which the residuals are linear, and an even veil.
Vector place_at(const Channel& channel, double a) {
  Vector place = Vector::Zero();
  place[0] = a;
  place[2] = 0.05;
  const Normal at = normal_at(channel, place, 0);
  place[2] -= at.gradient[2] / std::max(at.matrix(2, 2), 1e-300);
  return within_bounds(place);
}

// The best of the minima near several rates.
Vector start_of(const Channel& channel) {
  std::vector<Vector> places;
  double prior = std::numeric_limits<double>::max();
  for (const double a : {0.05, 0.2, 0.6, 1.5}) {
    places.push_back(place_at(channel, a));
    prior = std::min(prior, kPriorCost * normal_at(channel, places.back(), 0).cost);
  }
  Vector best = places.front();
  double least = std::numeric_limits<double>::max();
  for (const Vector& place : places) {
    const Vector minimum = minimised(channel, place, prior);
    const double cost = normal_at(channel, minimum, prior).cost;
    if (cost >= least) continue;
    least = cost;
    best = minimum;
  }
  return best;
}

// Equations that the unknowns fulfil in the mean, whatever the errors of the observations are: the
// difference of J between two observations of a point is 0. Its slopes contain J, for which the
// mean of the point's *other* observations is taken. In the least squares above, J contains the
// errors of the two, so that the solution is biased unless the ratio of their variances is exactly
// known.
struct Moments {
  Matrix matrix = Matrix::Zero();
  Vector sum = Vector::Zero();
  Matrix scatter = Matrix::Zero();  // of the points' parts of `sum`, and of the views'
  std::size_t points = 0;           // with three or more observations
};

// An observation's J, its precision, and the slopes of J besides those by a through the factor.
struct SurfaceOf {
  double light, precision, way;
  Vector slope;
};

SurfaceOf surface_of(const Channel& channel, std::size_t i, const Vector& p) {
  const Terms at = terms_of(channel.sights[i], p);
  return {(channel.light[i] - at.veil) / at.direct, channel.weight[i] * at.direct * at.direct,
          channel.sights[i].way, -at.slopes / at.direct};
}

Moments moments_at(const Channel& channel, const Vector& p, double prior) {
  Moments moments;
  std::map<std::uint32_t, Vector> of_view;
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
    Vector of_point = Vector::Zero();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j) {
        const SurfaceOf &one = seen[i], &two = seen[j];
        const double others = (product - one.precision * one.light - two.precision * two.light) /
                              (precision - one.precision - two.precision);
        Vector slope = one.slope - two.slope;
        slope[0] += others * (one.way - two.way);
        const double weight =
            2 / (1 / one.precision + 1 / two.precision) / static_cast<double>(count);
        const Vector part = weight * (one.light - two.light) * slope;
        moments.matrix += weight * slope * slope.transpose();
        of_point += part;
        for (const std::size_t k : {i, j})
          of_view.try_emplace(channel.views[begin + k], Vector::Zero()).first->second += part / 2;
      }
    moments.sum += of_point;
    moments.scatter += of_point * of_point.transpose();
    ++moments.points;
  }
  for (const auto& [view, part] : of_view) moments.scatter += part * part.transpose();
  const Vector weights = prior_weights(prior);
  moments.matrix.diagonal() += weights;
  moments.sum += weights.cwiseProduct(p);
  return moments;
}

// The fewest points with three observations for which the equations are used.
constexpr std::size_t kLeastMoments = 50;

// Solves the equations from a place near the solution. Returns the place if that fails.
Vector solved(const Channel& channel, const Vector& start, double prior) {
  constexpr int kMost = 30;
  Vector p = start;
  for (int i = 0; i < kMost; ++i) {
    Moments at = moments_at(channel, p, prior);
    if (at.points < kLeastMoments) return start;
    at.matrix.diagonal().array() += 1e-12 * at.matrix.trace();
    const Vector change = at.matrix.ldlt().solve(at.sum);
    if (!change.allFinite()) return start;
    const Vector next = within_bounds(p - change);
    const double step = (next - p).norm();
    p = next;
    if (step < 1e-7) return p;
  }
  return start;
}

// The covariance of the unknowns: by the scatter of points and of photographs, with that of the
// prior. With too few points for the equations it is that of least squares, for residuals with the
// standard deviation `scale`.
Matrix covariance_of(const Channel& channel, const Vector& p, double prior, double scale) {
  const auto inverse_of = [](Matrix matrix) -> Matrix {
    matrix.diagonal().array() += 1e-12 * matrix.trace();
    return matrix.inverse();
  };
  Moments at = moments_at(channel, p, prior);
  if (at.points < kLeastMoments)
    return scale * scale * inverse_of(normal_at(channel, p, prior).matrix);
  for (int k = 0; k < kUnknowns; ++k)
    at.scatter(k, k) +=
        std::pow(prior_weights(prior)[k] * kPriorSigmas[static_cast<std::size_t>(k)], 2);
  const Matrix inverse = inverse_of(at.matrix);
  return inverse * at.scatter * inverse;
}

// The error of `a` that the scatter of the observations does not show. The light of a piece of the
// surface is the same in all photographs to 0.1 % only, and a changes the light by the differences
// of the ways of a point; the model is right to 2 % of a. `direct`: direct_share().
double systematic_error(const Channel& channel, double a, double direct) {
  constexpr double kShareOfLight = 0.001, kShareOfModel = 0.02;
  double squares = 0;
  for (std::size_t point = 0; point < channel.points(); ++point) {
    const std::size_t begin = channel.first[point], end = channel.first[point + 1];
    double mean = 0;
    for (std::size_t i = begin; i < end; ++i)
      mean += channel.sights[i].way / static_cast<double>(end - begin);
    for (std::size_t i = begin; i < end; ++i) squares += std::pow(channel.sights[i].way - mean, 2);
  }
  const double ways = std::sqrt(squares / static_cast<double>(channel.light.size()));
  return std::hypot(kShareOfLight / std::max(direct * ways, 1e-9), kShareOfModel * a);
}

SunChannel fit(Channel channel) {
  constexpr std::size_t kLeastPoints = 10;
  constexpr int kReweighted = 8;
  constexpr double kLargestShare = 0.3;
  SunChannel result;
  if (channel.points() < kLeastPoints) return result;
  Vector p = start_of(part_of(channel, 1000));
  double prior = 0;
  for (int i = 0; i < kReweighted; ++i) {
    prior = kPriorCost * normal_at(channel, p, 0).cost;
    p = solved(channel, minimised(channel, p, prior), prior);
    const Normal at = normal_at(channel, p, prior);
    expect(channel, at.factors, at.surfaces);
    result.residual = weigh(channel, at.residuals);
  }
  const Matrix covariance = covariance_of(channel, p, prior, result.residual);
  const double b = veil_rate(p);
  Vector of_b = Vector::Zero();
  of_b.head<2>() << b / p[0], b;  // the derivatives of b
  const Normal at = normal_at(channel, p, prior);
  result.direct = direct_share(channel, at.factors, at.surfaces);
  const double a_sigma = std::hypot(std::sqrt(std::max(0.0, covariance(0, 0))),
                                    systematic_error(channel, p[0], result.direct));
  result.a = {p[0], a_sigma};
  result.b = {b, std::sqrt(std::max(0.0, of_b.dot(covariance * of_b)))};
  result.veil = {p[2], std::sqrt(std::max(0.0, covariance(2, 2)))};
  result.veil_by_direction = p.tail<3>();
  result.determined =
      result.a.sigma <= kLargestShare * result.a.value && result.direct >= kLeastDirect;
  return result;
}

}  // namespace

Eigen::Array3f SunWater::factor(const Sight& sight) const {
  Eigen::Array3f factor;
  for (int k = 0; k < 3; ++k) {
    const SunChannel& channel = channels[static_cast<std::size_t>(k)];
    factor[k] = static_cast<float>(
        std::exp(channel.daylight.value * (sight.height - level) - channel.a.value * sight.way));
  }
  return factor;
}

Eigen::Array3f SunWater::veil(const Sight& sight) const {
  const Eigen::Vector3d direction = sight.direction.cast<double>() - middle;
  Eigen::Array3f veil;
  for (int k = 0; k < 3; ++k) {
    const SunChannel& channel = channels[static_cast<std::size_t>(k)];
    const double full = channel.veil.value * std::exp(channel.veil_by_direction.dot(direction));
    veil[k] = static_cast<float>(full * (1 - std::exp(-channel.b.value * sight.way)));
  }
  return veil;
}

SunWater fit_sun(const Observations& observations, const Transfer& transfer) {
  SunWater water;
  for (const Observation& seen : observations.all)
    water.middle += seen.sight.direction.cast<double>();
  water.middle /= std::max(1.0, static_cast<double>(observations.all.size()));
  parallel_for(3, [&](std::size_t k) {
    Channel channel = channel_of(observations, static_cast<int>(k), transfer);
    for (Sight& sight : channel.sights) sight.direction -= water.middle.cast<float>();
    water.channels[k] = fit(std::move(channel));
  });
  return water;
}

}  // namespace axial::color
