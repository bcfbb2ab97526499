// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/residual_cause.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/order_statistics.h"
#include "base/parallel.h"
#include "diagnosis/cause_sample.h"
#include "diagnosis/free_directions.h"
#include "diagnosis/hypotheses.h"
#include "diagnosis/track_sample.h"

namespace axial::diagnosis {
namespace {

constexpr double kHardlyMore = 0.05;  // of the share

// A hypothesis about one camera or all, with the columns of its numbers.
struct Trial {
  Cause cause;
  std::vector<Eigen::Index> columns;
};

struct Trials {
  std::vector<Trial> trials;
  Eigen::Index columns = 1;  // of the matrix; column 0 holds the errors
};

// The part of the matrix's columns that a number fills: those observations whose camera has it.
struct Filling {
  Eigen::Index column;
  std::size_t camera;
  NumberStep number;
};

void add_camera(const CameraModel& model, std::size_t camera, Trials& all,
                std::vector<Filling>& fillings) {
  const Hypotheses about = hypotheses_of(model);
  for (const Hypothesis& hypothesis : about.hypotheses) {
    Trial trial{{camera, hypothesis.name, {}, 0}, {}};
    for (const std::size_t k : hypothesis.numbers) {
      trial.cause.numbers.push_back(about.numbers[k].number);
      trial.columns.push_back(all.columns + static_cast<Eigen::Index>(k));
    }
    all.trials.push_back(std::move(trial));
  }
  for (const NumberStep& number : about.numbers)
    fillings.push_back({all.columns++, camera, number});
}

// Adds the index of the water of all cameras together, if they state one value.
void add_common_index(std::span<const CameraModel> cameras, Trials& all,
                      std::vector<Filling>& fillings) {
  if (cameras.size() < 2) return;
  std::vector<Filling> common;
  for (std::size_t camera = 0; camera < cameras.size(); ++camera)
    if (cameras[camera].port)
      for (const NumberStep& step : hypotheses_of(cameras[camera]).numbers)
        if (step.number.quantity == pose::Quantity::index)
          common.push_back({all.columns, camera, step});
  if (common.size() < cameras.size()) return;
  const pose::HousingNumber& index = common.front().number.number;
  if (std::ranges::any_of(common,
                          [&](const Filling& f) { return f.number.number.before != index.before; }))
    return;
  all.trials.push_back({{kAllCameras, index.title, {index}, 0}, {all.columns++}});
  fillings.insert(fillings.end(), common.begin(), common.end());
}

void fill(const TrackedPhotographs& sample, const Filling& filling, Eigen::MatrixXd& matrix) {
  const AnyCamera<double> low(make_camera<double>(filling.number.low));
  const AnyCamera<double> high(make_camera<double>(filling.number.high));
  parallel_for(
      sample.observations.size(),
      [&](std::size_t i) {
        const pose::Observation& observation = sample.observations[i];
        const pose::BundleImage& image = sample.images[observation.image];
        if (image.camera != filling.camera) return;
        const Eigen::Vector3d X = image.pose.to_camera(sample.points[observation.point]);
        const auto before = low.project(X), after = high.project(X);
        if (!before.visible || !after.visible) return;
        matrix.block<2, 1>(2 * static_cast<Eigen::Index>(i), filling.column) =
            (after.pixel - before.pixel) / filling.number.step;
      },
      kPointGrain);
}

LinearizedTracks linearized(const TrackedPhotographs& sample) {
  const std::vector<AnyCamera<double>> cameras = cameras_of(sample);
  LinearizedTracks tracks;
  tracks.observations = sample.observations;
  tracks.points = sample.points.size();
  for (const pose::BundleImage& image : sample.images) tracks.centres.push_back(image.pose.centre);
  for (const pose::Observation& observation : sample.observations) {
    const pose::BundleImage& image = sample.images[observation.image];
    tracks.terms.push_back(observation_term(cameras[image.camera], image.pose,
                                            sample.points[observation.point], observation.pixel));
  }
  return tracks;
}

// The sum over all cameras of the squared systematic errors [px^2], times their observations.
double systematic_square(const TrackedPhotographs& sample, const Eigen::VectorXd& errors) {
  double sum = 0;
  for (std::size_t camera = 0; camera < sample.cameras.size(); ++camera) {
    std::vector<Eigen::Vector2d> pixels, here;
    for (std::size_t i = 0; i < sample.observations.size(); ++i) {
      if (sample.images[sample.observations[i].image].camera != camera) continue;
      pixels.push_back(sample.observations[i].pixel);
      here.emplace_back(errors.segment<2>(2 * static_cast<Eigen::Index>(i)));
    }
    const CameraModel& model = sample.cameras[camera];
    const ResidualPattern pattern = residual_pattern(pixels, here, model.width, model.height);
    sum += static_cast<double>(pattern.count) * pattern.systematic * pattern.systematic;
  }
  return sum;
}

double noise_of(const Eigen::VectorXd& errors) {
  return deviation_about_zero({errors.data(), errors.data() + errors.size()});
}

// Sets the changes of the trial and the share that they explain.
void judge(const TrackedPhotographs& sample, const Eigen::MatrixXd& matrix, double systematic,
           Trial& trial) {
  const Eigen::VectorXd errors = matrix.col(0);
  Eigen::MatrixXd columns(matrix.rows(), std::ssize(trial.columns));
  for (std::size_t k = 0; k < trial.columns.size(); ++k)
    columns.col(static_cast<Eigen::Index>(k)) = matrix.col(trial.columns[k]);
  const Eigen::MatrixXd normal = columns.transpose() * columns;
  const auto solver = normal.ldlt();
  if (!(normal.diagonal().minCoeff() > 0)) return;
  const Eigen::VectorXd change = solver.solve(columns.transpose() * errors);
  const Eigen::VectorXd left = errors - columns * change;
  if (!left.allFinite()) return;
  const Eigen::MatrixXd inverse =
      solver.solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  const double noise = noise_of(left);
  for (std::size_t k = 0; k < trial.cause.numbers.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    pose::HousingNumber& number = trial.cause.numbers[k];
    number.change = change[i];
    number.now = number.before + number.change;
    number.sigma = noise * std::sqrt(std::max(0.0, inverse(i, i)));
  }
  trial.cause.share = 1 - systematic_square(sample, left) / systematic;
}

// Whether the changed numbers can be those of a port or a lens. Lengths and the index of the water
// less that of air are positive; one linear step may go a little beyond zero. The thickness of the
// glass is easy to measure, and a thick glass looks like a distant one: a large change of the
// thickness is no cause.
bool is_possible(const Cause& cause) {
  constexpr double kBeyond = 0.25, kThicker = 3, kMillimetres = 5;
  return std::ranges::all_of(cause.numbers, [](const pose::HousingNumber& number) {
    using pose::Quantity;
    switch (number.quantity) {
      case Quantity::index:
        return number.now >= 1 - kBeyond * (number.before - 1);
      case Quantity::thickness:
        if (number.now > kThicker * number.before + kMillimetres) return false;
        [[fallthrough]];
      case Quantity::distance:
      case Quantity::radius:
      case Quantity::focal:
        return number.now >= -kBeyond * number.before;
      default:
        return true;
    }
  });
}

// The order of the causes: by share, without the advantage of more numbers.
double rank_of(const Cause& cause) {
  return cause.share - kHardlyMore * (static_cast<double>(cause.numbers.size()) - 1);
}

}  // namespace

std::vector<Cause> residual_causes(const TrackedPhotographs& photographs,
                                   std::span<const Eigen::Vector2d> freed,
                                   std::span<const std::size_t> suspects,
                                   const CauseLimits& limits) {
  if (suspects.empty()) return {};
  const TrackedPhotographs sample =
      cause_sample(photographs, freed, suspects[0], limits.images, limits.observations);
  if (!is_enough(sample)) return {};
  Trials all;
  std::vector<Filling> fillings;
  for (const std::size_t camera : suspects.first(std::min(suspects.size(), limits.cameras)))
    add_camera(sample.cameras[camera], camera, all, fillings);
  add_common_index(sample.cameras, all, fillings);
  const LinearizedTracks tracks = linearized(sample);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2 * std::ssize(sample.observations), all.columns);
  for (std::size_t i = 0; i < tracks.terms.size(); ++i)
    matrix.block<2, 1>(2 * static_cast<Eigen::Index>(i), 0) = tracks.terms[i].error;
  for (const Filling& filling : fillings) fill(sample, filling, matrix);
  remove_poses_and_points(tracks, matrix);
  const double systematic = systematic_square(sample, matrix.col(0));
  if (!(systematic > 0)) return {};
  for (Trial& trial : all.trials) judge(sample, matrix, systematic, trial);
  std::vector<Cause> causes;
  for (Trial& trial : all.trials)
    if (is_possible(trial.cause)) causes.push_back(std::move(trial.cause));
  std::ranges::stable_sort(causes, std::greater(), rank_of);
  return causes;
}

}  // namespace axial::diagnosis
