// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/targets: fits the outline of a uniform area to the pixels around it.
#pragma once

#include <ceres/jet.h>
#include <ceres/tiny_solver.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/order_statistics.h"

namespace axial::targets {

// An outline with `kShape` numbers, of which the first two are its place [px], and the step of
// brightness across it.
template <int kShape>
struct EdgeFit {
  Eigen::Matrix<double, kShape, 1> shape;
  // From the residuals of the pixels. It allows for errors that neighbouring pixels share.
  Eigen::Matrix<double, kShape, kShape> covariance;
  double outside = 0, inside = 0;  // brightness
  double blur = 1;                 // standard deviation of the blur [px]
  double noise = 0;                // standard deviation of the residuals
};

// The share of light from inside a straight edge that is blurred by a Gaussian. `distance` of the
// pixel from the edge, positive inside, in standard deviations of the blur.
template <class T>
T inside_share(const T& distance) {
  using std::erf;
  return 0.5 * (1.0 + erf(distance * std::sqrt(0.5)));
}

// The residuals of the model
//   brightness = outside + (inside - outside) share,
// where `share` is the share of the light of a pixel that comes from inside. The parameters are the
// shape, outside, inside and log(blur).
template <int kShape, class Share>
class EdgeResiduals {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = kShape + 3 };

  EdgeResiduals(const cv::Mat1f& picture, std::span<const cv::Point> pixels, const Share& share)
      : picture_(picture), pixels_(pixels), share_(share) {}

  int NumResiduals() const { return static_cast<int>(pixels_.size()); }

  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    using Jet = ceres::Jet<double, NUM_PARAMETERS>;
    std::array<Jet, NUM_PARAMETERS> p;
    for (int i = 0; i < NUM_PARAMETERS; ++i) p[static_cast<std::size_t>(i)] = Jet(parameters[i], i);
    const Jet per_blur = exp(-p[kShape + 2]);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const Jet share = share_(p.data(), static_cast<double>(pixels_[i].x),
                               static_cast<double>(pixels_[i].y), per_blur);
      const Jet residual = p[kShape] + (p[kShape + 1] - p[kShape]) * share -
                           static_cast<double>(picture_(pixels_[i]));
      if (!std::isfinite(residual.a)) return false;
      residuals[i] = residual.a;
      if (jacobian)
        for (int k = 0; k < NUM_PARAMETERS; ++k)
          jacobian[static_cast<std::size_t>(k) * pixels_.size() + i] = residual.v[k];
    }
    return true;
  }

 private:
  const cv::Mat1f& picture_;
  std::span<const cv::Point> pixels_;
  const Share& share_;
};

// The gradients of half the sum of squares, J^T r, each summed over a block of neighbouring pixels,
// as columns. With H = J^T J and S, the sum of their outer products, H^-1 S H^-1 is the
// covariance if errors in a block are alike, such as those of a bent side, of JPEG and of light
// that is not uniform.
template <int kCount>
Eigen::Matrix<double, kCount, Eigen::Dynamic> gradients_of_blocks(
    std::span<const cv::Point> pixels,
    const Eigen::Matrix<double, Eigen::Dynamic, kCount>& jacobian, const Eigen::VectorXd& errors) {
  constexpr int kBlock = 4;  // [px]
  std::map<std::pair<int, int>, Eigen::Matrix<double, kCount, 1>> sums;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::Matrix<double, kCount, 1> gradient = jacobian.row(row) * errors[row];
    const std::pair block(pixels[i].x / kBlock, pixels[i].y / kBlock);
    if (const auto [sum, is_new] = sums.try_emplace(block, gradient); !is_new)
      sum->second += gradient;
  }
  Eigen::Matrix<double, kCount, Eigen::Dynamic> gradients(kCount, sums.size());
  Eigen::Index column = 0;
  for (const auto& [block, sum] : sums) gradients.col(column++) = sum;
  return gradients;
}

// The standard deviation of the residuals. Few pixels lie beyond the model, at the next cells of a
// small marker.
inline double noise_of(const Eigen::VectorXd& errors) {
  const Eigen::VectorXd sizes = errors.cwiseAbs();
  return kSigmasOfMedian *
         upper_median(std::vector<double>(sizes.data(), sizes.data() + sizes.size()));
}

// The covariance of the numbers of a fit: that of independent errors with the standard deviation
// `noise`, or that of errors that blocks of pixels share, if the latter is larger for the place,
// the first two numbers. Nothing if the pixels do not determine the numbers.
template <int kCount>
std::optional<Eigen::Matrix<double, kCount, kCount>> covariance_of(
    std::span<const cv::Point> pixels, Eigen::Matrix<double, Eigen::Dynamic, kCount> jacobian,
    const Eigen::VectorXd& errors, double noise) {
  using Square = Eigen::Matrix<double, kCount, kCount>;
  constexpr double kLeastPivot = 1e-12;
  const Eigen::Matrix<double, kCount, 1> norms = jacobian.colwise().norm();
  if (!(norms.minCoeff() > 0)) return std::nullopt;
  const Square units = norms.cwiseInverse().asDiagonal();
  jacobian = jacobian * units;  // numbers have different units
  const Eigen::LDLT<Square> normal(jacobian.transpose() * jacobian);
  if (normal.info() != Eigen::Success || normal.vectorD().minCoeff() < kLeastPivot)
    return std::nullopt;
  const double count = static_cast<double>(pixels.size());
  const Square independent = noise * noise * count / (count - kCount) * units * normal.solve(units);
  const Eigen::Matrix<double, kCount, Eigen::Dynamic> by_block =
      units * normal.solve(gradients_of_blocks<kCount>(pixels, jacobian, errors));
  // The fit takes up as many errors of blocks as it has numbers. Of few blocks it would leave none;
  // the limit keeps the correction of the variance below a quarter.
  const double blocks = static_cast<double>(by_block.cols());
  const Square alike =
      by_block * by_block.transpose() * (blocks / std::max(0.8 * blocks, blocks - kCount));
  const auto of_place = [](const Square& all) {
    return all.template topLeftCorner<2, 2>().trace();
  };
  const Square covariance = of_place(alike) > of_place(independent) ? alike : independent;
  if (!covariance.allFinite()) return std::nullopt;
  return covariance;
}

// Fits an outline, begun at `start`, whose `blur` is only a first guess. `share(shape, x, y,
// per_blur)`: the share of the model above at the pixel (x, y), for ceres::Jet; `per_blur` is 1 /
// blur. `pixels` must lie in `picture`. Nothing if there are too few pixels or the pixels do not
// determine the outline.
template <int kShape, class Share>
std::optional<EdgeFit<kShape>> fit_edge(const cv::Mat1f& picture, std::span<const cv::Point> pixels,
                                        const EdgeFit<kShape>& start, const Share& share) {
  constexpr int kCount = kShape + 3;
  if (pixels.size() < 2 * kCount) return std::nullopt;
  using Residuals = EdgeResiduals<kShape, Share>;
  const Residuals residuals(picture, pixels, share);
  typename ceres::TinySolver<Residuals>::Parameters p;
  p << start.shape, start.outside, start.inside, std::log(start.blur);
  ceres::TinySolver<Residuals> solver;
  solver.options.max_num_iterations = 30;
  solver.Solve(residuals, &p);

  const auto count = static_cast<Eigen::Index>(pixels.size());
  Eigen::VectorXd errors(count);
  Eigen::Matrix<double, Eigen::Dynamic, kCount> jacobian(count, kCount);
  if (!residuals(p.data(), errors.data(), jacobian.data())) return std::nullopt;
  constexpr double kLeastBlur = 0.05, kMostBlur = 20;
  const double blur = std::exp(p[kShape + 2]), noise = noise_of(errors);
  if (!(blur >= kLeastBlur && blur <= kMostBlur)) return std::nullopt;
  const auto covariance = covariance_of<kCount>(pixels, std::move(jacobian), errors, noise);
  if (!covariance) return std::nullopt;
  return EdgeFit<kShape>{p.template head<kShape>(),
                         covariance->template topLeftCorner<kShape, kShape>(),
                         p[kShape],
                         p[kShape + 1],
                         blur,
                         noise};
}

}  // namespace axial::targets
