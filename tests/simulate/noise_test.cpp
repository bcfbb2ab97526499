// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/noise.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "simulate/noise_corners.h"

namespace axial::simulate {
namespace {

struct Moments {
  double mean, deviation;
};

Moments moments(const std::function<float(const Eigen::Vector3d&)>& field) {
  double sum = 0, squares = 0;
  constexpr int kCount = 100000;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const Eigen::Vector3d p(uniform(1, 3 * i), uniform(1, 3 * i + 1), uniform(1, 3 * i + 2));
    const double value = field(500 * (p - Eigen::Vector3d::Constant(0.5)));
    sum += value;
    squares += value * value;
  }
  const double mean = sum / kCount;
  return {mean, std::sqrt(squares / kCount - mean * mean)};
}

TEST(Noise, HasTheMomentsItPromises) {
  const Moments m = moments([](const Eigen::Vector3d& p) { return gradient_noise(p, 7); });
  EXPECT_NEAR(m.mean, 0, 0.004);  // five standard errors
  EXPECT_NEAR(m.deviation, 0.19, 0.01);
}

TEST(Noise, IsZeroOnTheLatticeAndSmoothAcrossIt) {
  for (const double x : {-3.0, 0.0, 12.0}) {
    EXPECT_EQ(gradient_noise({x, 5, -2}, 3), 0.0f);
    const double h = 1e-4;
    const double left = gradient_noise({x - h, 5.3, -2.6}, 3);
    const double right = gradient_noise({x + h, 5.3, -2.6}, 3);
    EXPECT_NEAR(left, right, 10 * h);  // slopes stay below about 3
  }
}

TEST(Noise, IsTheSameBytesOnEveryProcessor) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "needs a processor with AVX2";
  for (std::uint64_t i = 0; i < 10000; ++i) {
    detail::NoiseCell cell{{}, {}, static_cast<std::uint32_t>(i)};
    for (std::size_t k = 0; k < 3; ++k) {
      cell.hash[k] = static_cast<std::uint32_t>(0x1p32 * uniform(2, 6 * i + k));
      cell.offset[k] = static_cast<float>(uniform(2, 6 * i + 3 + k));
    }
    // Corners are included, where zeros have signs.
    if (i % 10 < 3) cell.offset[i % 10] = i % 20 < 10 ? 0.0f : 1.0f;
    using Bits = std::array<std::uint32_t, 8>;
    ASSERT_EQ(std::bit_cast<Bits>(detail::corners_scalar(cell)),
              std::bit_cast<Bits>(detail::corners_avx2(cell)))
        << "cell " << i;
  }
}

TEST(Noise, FieldsOfDifferentSeedsAreUnrelated) {
  const Moments a = moments([](const Eigen::Vector3d& p) { return gradient_noise(p, 1); });
  const Moments sum =
      moments([](const Eigen::Vector3d& p) { return gradient_noise(p, 1) + gradient_noise(p, 2); });
  EXPECT_NEAR(sum.deviation, std::sqrt(2.0) * a.deviation, 0.02 * sum.deviation);
}

TEST(Noise, DoesNotRepeat) {
  // If the field had one of these periods along an axis, the difference would vanish.
  for (const double period : {16.0, 64.0, 256.0, 289.0, 1024.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d shift = period * Eigen::Vector3d::Unit(axis);
      const Moments m = moments([&](const Eigen::Vector3d& p) {
        return gradient_noise(p, 7) - gradient_noise(p + shift, 7);
      });
      EXPECT_GT(m.deviation, 0.25) << "period " << period << ", axis " << axis;
    }
  }
}

}  // namespace
}  // namespace axial::simulate
