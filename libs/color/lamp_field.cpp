// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/lamp_field.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/order_statistics.h"
#include "base/parallel.h"
#include "color/channel.h"

namespace axial::color {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kOffset = 0.25;  // [m]
// What is expected of J, with its standard deviation. It sets the scale, and the level of channels
// of which little light is left.
constexpr double kMeanSurface = 0.25, kSurfaceSigma = 0.2;
constexpr double kPrior = 1 / (kSurfaceSigma * kSurfaceSigma);
constexpr int kSaturationSteps = 64;
constexpr double kLeastPrecise = 0.3;  // of J, as a share: a channel with less is not determined

// A place between nodes: their indices and weights.
template <std::size_t N>
struct Between {
  std::array<int, N> node;
  std::array<double, N> weight;
};

// The node before `at`, and how far `at` is towards the next one.
std::pair<int, double> cell_of(double at, int nodes) {
  const double inside = std::clamp(at, 0.0, nodes - 1.0);
  const int before = std::min(static_cast<int>(inside), std::max(0, nodes - 2));
  return {before, inside - before};
}

Between<4> place_between(const LampGrid& grid, const Sight& sight) {
  const auto [i, a] = cell_of((sight.place.x() + 1.0) / 2 * (grid.across - 1), grid.across);
  const auto [j, b] =
      cell_of((sight.place.y() / grid.half_height + 1.0) / 2 * (grid.down - 1), grid.down);
  const int node = j * grid.across + i;
  return {{node, node + 1, node + grid.across, node + grid.across + 1},
          {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b}};
}

Between<8> node_between(const LampGrid& grid, const Sight& sight) {
  const Between<4> place = place_between(grid, sight);
  const double range = std::max(1e-6f, grid.farthest - grid.nearest);
  const auto [k, c] = cell_of((sight.way - grid.nearest) / range * (grid.along - 1), grid.along);
  Between<8> between;
  for (std::size_t i = 0; i < 4; ++i) {
    between.node[i] = place.node[i] + k * grid.places();
    between.node[i + 4] = between.node[i] + grid.places();
    between.weight[i] = (1 - c) * place.weight[i];
    between.weight[i + 4] = c * place.weight[i];
  }
  return between;
}

double base_of(const LampChannel& channel, double way) {
  const double d = std::max(way, 0.05);
  return std::exp(-2 * channel.loss * d) / (d * d);
}

double saturation_of(const LampGrid& grid, const LampChannel& channel, double way) {
  const auto [i, a] = cell_of(way / grid.farthest * kSaturationSteps, kSaturationSteps + 1);
  const auto k = static_cast<std::size_t>(i);
  return (1 - a) * channel.saturation[k] + a * channel.saturation[k + 1];
}

// T at equal steps: the integral of exp(-2 loss s) / (s^2 + kOffset^2), as a share of that over
// three times the farthest way.
std::vector<float> saturation_table(double loss, double farthest) {
  std::vector<float> table{0};
  const double step = farthest / kSaturationSteps;
  double sum = 0;
  for (int i = 0; i < 3 * kSaturationSteps; ++i) {
    const double s = (i + 0.5) * step;
    sum += std::exp(-2 * loss * s) / (s * s + kOffset * kOffset);
    if (i < kSaturationSteps) table.push_back(static_cast<float>(sum));
  }
  for (float& value : table) value /= static_cast<float>(sum);
  return table;
}

// The rate at which light is lost, one way, from pairs of observations of the same point. The veil
// is neglected: the number only makes E smooth.
double loss_of(const Channel& channel) {
  struct Slope {
    double value, weight;
  };
  std::vector<Slope> slopes;
  double total = 0;
  for (std::size_t point = 0; point < channel.points(); ++point) {
    const auto level = [&](std::size_t i) {
      const Sight& sight = channel.sights[i];
      return std::log(std::max(channel.light[i], 1e-4) * sight.way * sight.way /
                      std::max(0.1f, -sight.normal.z()));
    };
    const std::size_t begin = channel.first[point];
    for (std::size_t i = begin + 1; i < channel.first[point + 1]; ++i) {
      const double farther = channel.sights[i].way - channel.sights[begin].way;
      if (std::abs(farther) < 0.02) continue;
      slopes.push_back({(level(i) - level(begin)) / farther, std::abs(farther)});
      total += slopes.back().weight;
    }
  }
  std::ranges::sort(slopes, {}, &Slope::value);
  double sum = 0;
  for (const Slope& slope : slopes)
    if ((sum += slope.weight) >= 0.5 * total)
      return std::clamp(-0.5 * slope.value, kLeastLoss, 3.0);
  return 0.1;
}

// The unknowns of a channel: E at nodes, then V at places.
class LampFit {
 public:
  LampFit(Channel channel, const LampGrid& grid) : channel_(std::move(channel)), grid_(grid) {
    result_.loss = loss_of(channel_);
    result_.saturation = saturation_table(result_.loss, grid_.farthest);
    unknowns_ = VectorXd::Zero(3 * grid_.nodes() + grid_.places());
    for (int node = 0; node < grid_.nodes(); ++node) unknowns_[3 * node + 2] = -1;
    for (const Sight& sight : channel_.sights) terms_.push_back(term_of(sight));
    scale_surfaces();
  }

  LampChannel run() {
    constexpr int kIterations = 12;
    constexpr double kEnough = 2e-3;
    for (int i = 0; i < kIterations; ++i) {
      expect_errors();
      result_.residual = weigh(channel_, residuals(unknowns_));
      const VectorXd before = unknowns_;
      step();
      if ((unknowns_ - before).norm() < kEnough * before.norm()) break;
    }
    for (int node = 0; node < grid_.nodes(); ++node)
      result_.light.push_back(unknowns_.segment<3>(3 * node));
    for (int place = 0; place < grid_.places(); ++place)
      result_.veil.push_back(unknowns_[3 * grid_.nodes() + place]);
    result_.direct = share_of_surfaces();
    result_.determined = determines_surfaces() && result_.direct >= kLeastDirect;
    return std::move(result_);
  }

 private:
  // The derivatives of factor and veil of an observation by the unknowns.
  struct Term {
    std::array<int, 24> of_light;
    std::array<double, 24> light;
    std::array<int, 4> of_veil;
    std::array<double, 4> veil;
  };

  Term term_of(const Sight& sight) const {
    Term term;
    const Between<8> node = node_between(grid_, sight);
    const Between<4> place = place_between(grid_, sight);
    const double base = base_of(result_, sight.way);
    const double saturation = saturation_of(grid_, result_, sight.way);
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        term.of_light[3 * i + axis] = 3 * node.node[i] + static_cast<int>(axis);
        term.light[3 * i + axis] =
            base * node.weight[i] * sight.normal[static_cast<Eigen::Index>(axis)];
      }
    for (std::size_t i = 0; i < 4; ++i) {
      term.of_veil[i] = 3 * grid_.nodes() + place.node[i];
      term.veil[i] = saturation * place.weight[i];
    }
    return term;
  }

  static double factor_of(const Term& term, const VectorXd& at) {
    double factor = 0;
    for (std::size_t i = 0; i < 24; ++i) factor += term.light[i] * at[term.of_light[i]];
    return factor;
  }
  static double veil_of(const Term& term, const VectorXd& at) {
    double veil = 0;
    for (std::size_t i = 0; i < 4; ++i) veil += term.veil[i] * at[term.of_veil[i]];
    return veil;
  }

  // J of a point.
  double surface_of(std::size_t point, const VectorXd& at) const {
    double squares = kPrior, product = kPrior * kMeanSurface;
    for (std::size_t i = channel_.first[point]; i < channel_.first[point + 1]; ++i) {
      const double factor = factor_of(terms_[i], at);
      squares += channel_.weight[i] * factor * factor;
      product += channel_.weight[i] * factor * (channel_.light[i] - veil_of(terms_[i], at));
    }
    return product / squares;
  }

  // Whether the observations tell J: not if the median standard deviation of J is above
  // kLeastPrecise times its mean, and not if J differs between points by less than twice this
  // deviation. Then J may as well be a part of the veil.
  bool determines_surfaces() const {
    std::vector<double> sigmas, surfaces;
    for (std::size_t point = 0; point < channel_.points(); ++point) {
      double squares = 1e-300;
      for (std::size_t i = channel_.first[point]; i < channel_.first[point + 1]; ++i)
        squares += channel_.weight[i] * std::pow(factor_of(terms_[i], unknowns_), 2);
      sigmas.push_back(1 / std::sqrt(squares));
      surfaces.push_back(surface_of(point, unknowns_));
    }
    const double sigma = result_.residual * upper_median(std::move(sigmas));
    return sigma <= kLeastPrecise * kMeanSurface &&
           robust_deviation(std::move(surfaces)) >= 2 * sigma;
  }

  std::vector<double> factors() const {
    std::vector<double> factors;
    for (const Term& term : terms_) factors.push_back(factor_of(term, unknowns_));
    return factors;
  }
  std::vector<double> surfaces() const {
    std::vector<double> surfaces;
    for (std::size_t point = 0; point < channel_.points(); ++point)
      surfaces.push_back(surface_of(point, unknowns_));
    return surfaces;
  }

  void expect_errors() { expect(channel_, factors(), surfaces()); }

  double share_of_surfaces() const { return direct_share(channel_, factors(), surfaces()); }

  std::vector<double> residuals(const VectorXd& at) const {
    std::vector<double> all(channel_.light.size());
    for (std::size_t point = 0; point < channel_.points(); ++point) {
      const double surface = surface_of(point, at);
      for (std::size_t i = channel_.first[point]; i < channel_.first[point + 1]; ++i)
        all[i] = channel_.light[i] - surface * factor_of(terms_[i], at) - veil_of(terms_[i], at);
    }
    return all;
  }

  double cost(const VectorXd& at) const {
    const std::vector<double> all = residuals(at);
    double sum = 0;
    for (std::size_t i = 0; i < all.size(); ++i) sum += channel_.weight[i] * all[i] * all[i];
    for (std::size_t point = 0; point < channel_.points(); ++point)
      sum += kPrior * std::pow(surface_of(point, at) - kMeanSurface, 2);
    return sum + smoothness(at);
  }

  // Adds a point to the normal equations, without its J. Of the matrix only the lower triangle is
  // used.
  void add_point(std::size_t point, MatrixXd& matrix, VectorXd& gradient) const {
    const double surface = surface_of(point, unknowns_);
    std::vector<int> index;
    std::vector<double> shared;
    double squares = kPrior;
    for (std::size_t i = channel_.first[point]; i < channel_.first[point + 1]; ++i) {
      const Term& term = terms_[i];
      std::array<int, 28> where;
      std::array<double, 28> slope;  // of the model's light
      for (std::size_t k = 0; k < 24; ++k) {
        where[k] = term.of_light[k];
        slope[k] = surface * term.light[k];
      }
      std::ranges::copy(term.of_veil, where.begin() + 24);
      std::ranges::copy(term.veil, slope.begin() + 24);
      const double weight = channel_.weight[i], factor = factor_of(term, unknowns_);
      const double residual = channel_.light[i] - surface * factor - veil_of(term, unknowns_);
      for (std::size_t k = 0; k < 28; ++k) {
        gradient[where[k]] += weight * residual * slope[k];
        for (std::size_t l = 0; l < 28; ++l)
          if (where[l] <= where[k]) matrix(where[k], where[l]) += weight * slope[k] * slope[l];
        index.push_back(where[k]);
        shared.push_back(weight * factor * slope[k]);
      }
      squares += weight * factor * factor;
    }
    merge(index, shared);
    for (std::size_t l = 0; l < index.size(); ++l)
      for (std::size_t k = l; k < index.size(); ++k)
        matrix(index[k], index[l]) -= shared[k] * shared[l] / squares;
  }

  // Adds up values of equal indices.
  static void merge(std::vector<int>& index, std::vector<double>& values) {
    std::vector<std::pair<int, double>> pairs;
    for (std::size_t i = 0; i < index.size(); ++i) pairs.emplace_back(index[i], values[i]);
    std::ranges::stable_sort(pairs, {}, &std::pair<int, double>::first);
    index.clear();
    values.clear();
    for (const auto& [key, value] : pairs) {
      if (index.empty() || index.back() != key) {
        index.push_back(key);
        values.push_back(0);
      }
      values.back() += value;
    }
  }

  // Calls use(a, b, c, scale) for each three unknowns in a row of the grid, whose second difference
  // is expected to be 0 within `scale`.
  template <class Use>
  void for_each_triple(const VectorXd& at, const Use& use) const {
    constexpr double kLight = 0.1, kVeil = 0.1;  // of the mean
    double light = 0, veil = 1e-4;
    for (int node = 0; node < grid_.nodes(); ++node)
      light += at.segment<3>(3 * node).norm() / grid_.nodes();
    const int first_veil = 3 * grid_.nodes();
    for (int place = 0; place < grid_.places(); ++place)
      veil += std::abs(at[first_veil + place]) / grid_.places();
    const auto along = [&](int node, int stride, int position, int count) {
      if (position == 0 || position + 1 >= count) return;
      for (int axis = 0; axis < 3; ++axis)
        use(3 * (node - stride) + axis, 3 * node + axis, 3 * (node + stride) + axis,
            kLight * light);
      if (node < grid_.places() && stride < grid_.places())
        use(first_veil + node - stride, first_veil + node, first_veil + node + stride,
            kVeil * veil);
    };
    for (int node = 0; node < grid_.nodes(); ++node) {
      const int place = node % grid_.places();
      along(node, 1, place % grid_.across, grid_.across);
      along(node, grid_.across, place / grid_.across, grid_.down);
      along(node, grid_.places(), node / grid_.places(), grid_.along);
    }
  }

  double smoothness(const VectorXd& at) const {
    double sum = 0;
    for_each_triple(unknowns_, [&](int a, int b, int c, double scale) {
      const double difference = (at[a] - 2 * at[b] + at[c]) / scale;
      sum += difference * difference;
    });
    return sum;
  }

  void add_smoothness(MatrixXd& matrix, VectorXd& gradient) const {
    for_each_triple(unknowns_, [&](int a, int b, int c, double scale) {
      const std::array<int, 3> where{a, b, c};
      constexpr std::array<double, 3> kFactor{1, -2, 1};
      const double difference = unknowns_[a] - 2 * unknowns_[b] + unknowns_[c];
      for (std::size_t k = 0; k < 3; ++k) {
        gradient[where[k]] -= kFactor[k] * difference / (scale * scale);
        for (std::size_t l = 0; l < 3; ++l)
          if (where[l] <= where[k])
            matrix(where[k], where[l]) += kFactor[k] * kFactor[l] / (scale * scale);
      }
    });
  }

  // One step of Gauss and Newton, damped until the cost falls.
  void step() {
    constexpr std::size_t kParts = 8;  // a fixed number: sums do not depend on the threads
    constexpr int kTries = 6;
    const auto size = unknowns_.size();
    std::vector<MatrixXd> matrices(kParts, MatrixXd::Zero(size, size));
    std::vector<VectorXd> gradients(kParts, VectorXd::Zero(size));
    parallel_for(kParts, [&](std::size_t part) {
      for (std::size_t i = part; i < channel_.points(); i += kParts)
        add_point(i, matrices[part], gradients[part]);
    });
    MatrixXd matrix = matrices[0];
    VectorXd gradient = gradients[0];
    for (std::size_t part = 1; part < kParts; ++part) {
      matrix += matrices[part];
      gradient += gradients[part];
    }
    add_smoothness(matrix, gradient);
    const double before = cost(unknowns_);
    double damping = 1e-10;
    for (int i = 0; i < kTries; ++i, damping *= 300) {
      MatrixXd damped = matrix;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += 1e-13 * matrix.trace() / static_cast<double>(size);
      VectorXd next = unknowns_ + damped.ldlt().solve(gradient);
      next.tail(grid_.places()) = next.tail(grid_.places()).cwiseMax(0);
      if (!next.allFinite() || cost(next) >= before) continue;
      unknowns_ = next;
      return;
    }
  }

  // Scales E so that the mean of J is kMeanSurface: only the product is determined.
  void scale_surfaces() {
    double sum = 0;
    for (std::size_t point = 0; point < channel_.points(); ++point)
      sum += surface_of(point, unknowns_);
    const double mean = sum / static_cast<double>(channel_.points());
    if (mean > 0) unknowns_.head(3 * grid_.nodes()) *= mean / kMeanSurface;
  }

  Channel channel_;
  LampGrid grid_;
  LampChannel result_;
  VectorXd unknowns_;
  std::vector<Term> terms_;
};

LampGrid grid_of(const Observations& observations) {
  LampGrid grid;
  std::vector<float> ways, heights;
  for (const Observation& seen : observations.all) {
    ways.push_back(seen.sight.way);
    heights.push_back(std::abs(seen.sight.place.y()));
  }
  if (ways.empty()) return grid;
  grid.nearest = lower_quantile(ways, 0.005);
  grid.farthest = std::max(grid.nearest + 1e-3f, lower_quantile(ways, 0.995));
  grid.half_height = std::max(0.1f, std::ranges::max(heights));
  return grid;
}

}  // namespace

Eigen::Array3f LampField::factor(const Sight& sight) const {
  const Between<8> between = node_between(grid, sight);
  Eigen::Array3f factor = Eigen::Array3f::Ones();
  for (int k = 0; k < 3; ++k) {
    const LampChannel& channel = channels[static_cast<std::size_t>(k)];
    if (!channel.determined) continue;
    Eigen::Vector3d light = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < 8; ++i)
      light += between.weight[i] * channel.light[static_cast<std::size_t>(between.node[i])];
    factor[k] = static_cast<float>(base_of(channel, sight.way) *
                                   std::max(0.0, light.dot(sight.normal.cast<double>())));
  }
  return factor;
}

Eigen::Array3f LampField::veil(const Sight& sight) const {
  const Between<4> between = place_between(grid, sight);
  Eigen::Array3f veil = Eigen::Array3f::Zero();
  for (int k = 0; k < 3; ++k) {
    const LampChannel& channel = channels[static_cast<std::size_t>(k)];
    if (!channel.determined) continue;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      sum += between.weight[i] * channel.veil[static_cast<std::size_t>(between.node[i])];
    veil[k] = static_cast<float>(sum * saturation_of(grid, channel, sight.way));
  }
  return veil;
}

LampField fit_lamps(const Observations& observations, const Transfer& transfer) {
  constexpr std::size_t kLeastPoints = 200;
  const Observations open = without_shadows(observations);
  LampField field;
  field.grid = grid_of(open);
  for (std::size_t k = 0; k < 3; ++k) {
    Channel channel = channel_of(open, static_cast<int>(k), transfer);
    if (channel.points() < kLeastPoints) continue;
    field.channels[k] = LampFit(std::move(channel), field.grid).run();
  }
  return field;
}

}  // namespace axial::color
