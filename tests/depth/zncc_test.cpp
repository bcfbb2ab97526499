// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/patch/zncc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <random>

namespace axial::depth {
namespace {

cv::Mat1b random_image(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  cv::Mat1b image(height, width);
  for (std::uint8_t& value : image) value = static_cast<std::uint8_t>(random() % 256);
  return image;
}

TexelPositions random_positions(std::mt19937& random, float low, float high) {
  std::uniform_real_distribution<float> position(low, high);
  TexelPositions at;
  for (std::size_t k = 0; k < kPaddedTexels; ++k) {
    at.x[k] = k < kTexels ? position(random) : at.x[0];
    at.y[k] = k < kTexels ? position(random) : at.y[0];
  }
  return at;
}

double bilinear(const cv::Mat1b& image, double x, double y) {
  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(std::floor(y));
  const double fx = x - x0;
  const double fy = y - y0;
  return (1 - fy) * ((1 - fx) * image(y0, x0) + fx * image(y0, x0 + 1)) +
         fy * ((1 - fx) * image(y0 + 1, x0) + fx * image(y0 + 1, x0 + 1));
}

bool inside(const cv::Mat1b& image, int x, int y) {
  return x >= 0 && y >= 0 && x < image.cols && y < image.rows;
}

// The factor of a texel's weight: 1 if it is at least one pixel inside the image, 0 outside.
double share(const cv::Mat1b& image, double x, double y) {
  const double least = std::min(std::min(x, image.cols - 1 - x), std::min(y, image.rows - 1 - y));
  return std::clamp(least, 0.0, 1.0);
}

// ZNCC by its definition, in double, over the texels that lie in both images. The weights are
// computed from the images.
double zncc_by_definition(const cv::Mat1b& reference, int cx, int cy, const cv::Mat1b& source,
                          const TexelPositions& at, const PatchMatchOptions& options) {
  std::vector<double> w, a, b;
  double sum = 0;
  for (std::size_t k = 0; k < kTexels; ++k) {
    const double dx = kTexelOffsets.x[k];
    const double dy = kTexelOffsets.y[k];
    const int x = cx + static_cast<int>(dx), y = cy + static_cast<int>(dy);
    const double counts = share(source, at.x[k], at.y[k]);
    if (!inside(reference, x, y) || counts == 0) continue;
    a.push_back(reference(y, x) / 255.0);
    const double difference = a.back() - reference(cy, cx) / 255.0;
    w.push_back(counts *
                std::exp(-difference * difference / (2 * std::pow(options.sigma_color, 2)) -
                         (dx * dx + dy * dy) / (2 * std::pow(options.sigma_space, 2))));
    b.push_back(bilinear(source, at.x[k], at.y[k]) / 255.0);
    sum += w.back();
  }
  double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t k = 0; k < w.size(); ++k) {
    mean_a += w[k] * a[k] / sum;
    mean_b += w[k] * b[k] / sum;
  }
  for (std::size_t k = 0; k < w.size(); ++k) {
    aa += w[k] * (a[k] - mean_a) * (a[k] - mean_a);
    bb += w[k] * (b[k] - mean_b) * (b[k] - mean_b);
    ab += w[k] * (a[k] - mean_a) * (b[k] - mean_b);
  }
  return ab / std::sqrt(aa * bb);
}

ReferencePatch patch_at(const PatchSampler& sampler, const cv::Mat1b& image, int x, int y) {
  ReferencePatch patch;
  sampler.gather(image, x, y, patch);
  return patch;
}

TEST(Zncc, AgreesWithTheDefinition) {
  const PatchMatchOptions options;
  const PatchSampler sampler(options);
  std::mt19937 random(1);
  for (unsigned trial = 0; trial < 200; ++trial) {
    const cv::Mat1b reference = random_image(40, 30, trial);
    const cv::Mat1b source = random_image(50, 40, trial + 1000);
    const int x = 4 + static_cast<int>(random() % 32);
    const int y = 4 + static_cast<int>(random() % 22);
    const TexelPositions at = random_positions(random, 1, 38);
    const float found = zncc_scalar(patch_at(sampler, reference, x, y), QuadImage(source), at);
    // Rounding changes the sums of 25 floats by some 1e-7 of the variance.
    EXPECT_NEAR(found, zncc_by_definition(reference, x, y, source, at, options), 2e-5);
  }
}

// Reference pixels up to the image's edge, and source windows that lie partly outside the image.
TEST(Zncc, AgreesWithTheDefinitionOverWhatLiesInside) {
  const PatchMatchOptions options;
  const PatchSampler sampler(options);
  std::mt19937 random(8);
  int correlated = 0;
  for (unsigned trial = 0; trial < 1000; ++trial) {
    const cv::Mat1b reference = random_image(40, 30, trial);
    const cv::Mat1b source = random_image(50, 40, trial + 1000);
    const int x = static_cast<int>(random() % 40);
    const int y = static_cast<int>(random() % 30);
    const TexelPositions at = random_positions(random, -10, 49);
    const float found = zncc_scalar(patch_at(sampler, reference, x, y), QuadImage(source), at);
    if (found == kNoCorrelation) continue;
    ++correlated;
    EXPECT_GT(share(source, at.x[kCentreTexel], at.y[kCentreTexel]), 0);
    // The tolerance is larger, because the variance of few texels is a difference of larger sums.
    EXPECT_NEAR(found, zncc_by_definition(reference, x, y, source, at, options), 1e-4);
  }
  EXPECT_GT(correlated, 300);
}

// A discontinuity at the image's edge would penalise correct planes.
TEST(Zncc, ChangesLittleFromStepToStepAsAWindowLeavesTheImage) {
  const PatchSampler sampler{PatchMatchOptions()};
  cv::Mat1b image = random_image(60, 60, 9);
  cv::GaussianBlur(image, image, {}, 2);
  const ReferencePatch patch = patch_at(sampler, image, 20, 20);
  const QuadImage source(image);
  float last = kNoCorrelation;
  int correlated = 0;
  constexpr float kStep = 0.01f;
  for (float x = 12; x > -2; x -= kStep) {
    TexelPositions at;
    for (std::size_t k = 0; k < kPaddedTexels; ++k) {
      at.x[k] = x + kTexelOffsets.x[k];
      at.y[k] = 20 + kTexelOffsets.y[k];
    }
    const float found = zncc_scalar(patch, source, at);
    if (found != kNoCorrelation && last != kNoCorrelation) {
      // The weight of a texel grows gradually over one pixel, and the image is blurred.
      EXPECT_LT(std::abs(found - last), 5 * kStep) << x;
      ++correlated;
    }
    last = found;
  }
  EXPECT_GT(correlated, 1150);  // nearly all steps up to the image's edge
  EXPECT_EQ(last, kNoCorrelation);
}

TEST(Zncc, FastestGivesTheBytesOfTheScalarReference) {
  const PatchSampler sampler{PatchMatchOptions()};
  const ZnccFunction fast = fastest_zncc();
  std::mt19937 random(2);
  for (unsigned trial = 0; trial < 500; ++trial) {
    const cv::Mat1b image = random_image(64, 48, trial);
    const ReferencePatch patch = patch_at(sampler, image, 10, 10);
    // Every second patch lies partly outside.
    const TexelPositions at = random_positions(random, trial % 2 ? -1.0f : 1.0f, 46.5f);
    EXPECT_EQ(fast(patch, QuadImage(image), at), zncc_scalar(patch, QuadImage(image), at));
  }
}

TEST(Zncc, IsOneForTheSamePatchUnderAnyBrightnessAndContrast) {
  const PatchSampler sampler{PatchMatchOptions()};
  const cv::Mat1b image = random_image(40, 40, 7);
  cv::Mat1b dimmer;
  image.convertTo(dimmer, CV_8U, 0.5, 60);
  TexelPositions at;
  for (std::size_t k = 0; k < kPaddedTexels; ++k) {
    at.x[k] = 20 + kTexelOffsets.x[k];
    at.y[k] = 20 + kTexelOffsets.y[k];
  }
  const ReferencePatch patch = patch_at(sampler, image, 20, 20);
  EXPECT_NEAR(zncc_scalar(patch, QuadImage(image), at), 1.0f, 1e-5f);
  EXPECT_NEAR(zncc_scalar(patch, QuadImage(dimmer), at), 1.0f, 2e-3f);  // grey levels are rounded
}

TEST(Zncc, SaysSoWhereThereIsNoCorrelation) {
  const PatchSampler sampler{PatchMatchOptions()};
  const cv::Mat1b image = random_image(40, 40, 3);
  const ReferencePatch patch = patch_at(sampler, image, 20, 20);
  const QuadImage flat(cv::Mat1b(40, 40, std::uint8_t{90}));
  std::mt19937 random(4);
  const TexelPositions inside = random_positions(random, 5, 30);
  for (const ZnccFunction zncc : {&zncc_scalar, fastest_zncc()}) {
    EXPECT_EQ(zncc(patch, flat, inside), kNoCorrelation);
    for (const float bad : {-0.5f, 39.5f, -1e9f, 1e9f, std::numeric_limits<float>::quiet_NaN()}) {
      TexelPositions at = inside;
      at.x[kCentreTexel + 1] = bad;
      EXPECT_NE(zncc(patch, QuadImage(image), at), kNoCorrelation) << bad;
      at.x[kCentreTexel] = bad;
      EXPECT_EQ(zncc(patch, QuadImage(image), at), kNoCorrelation) << bad;
      at = inside;
      for (std::size_t k = 0; k < kTexels; ++k)
        if (k != kCentreTexel) at.y[k] = bad;
      EXPECT_EQ(zncc(patch, QuadImage(image), at), kNoCorrelation) << bad;
    }
  }
}

}  // namespace
}  // namespace axial::depth
