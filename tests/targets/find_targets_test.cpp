// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/finders/find_targets.h"

#include <gmock/gmock.h>

#include "targets/drawn_plate.h"

namespace axial::targets {
namespace {

using test::PlateView;

constexpr double kDegree = std::numbers::pi / 180;

PlateView random_view(std::mt19937& random, double least_width, double most_width) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  PlateView view;
  view.centre = {uniform(120, 200), uniform(90, 150)};
  view.width = uniform(least_width, most_width);
  view.oblique = uniform(0, 60) * kDegree;
  view.tilt_axis = uniform(0, 6.28);
  view.turn = uniform(0, 6.28);
  view.seed = static_cast<unsigned>(random());
  return view;
}

// The centre of the image of the dot's outline, which is an ellipse in a pinhole photograph.
Eigen::Vector2d centre_of_dot(const PlateView& view, const Pattern& pattern) {
  std::vector<cv::Point2d> outline;
  for (int i = 0; i < 64; ++i) {
    const double angle = 2 * std::numbers::pi * i / 64;
    const Eigen::Vector2d p =
        test::image_of(view, pattern, {std::cos(angle), std::sin(angle)}) - view.centre;
    outline.emplace_back(100 * p.x(), 100 * p.y());
  }
  cv::Mat points(static_cast<int>(outline.size()), 1, CV_64FC2, outline.data());
  points.convertTo(points, CV_32F);
  const cv::Point2f centre = cv::fitEllipse(points).center;
  return view.centre +
         Eigen::Vector2d(static_cast<double>(centre.x), static_cast<double>(centre.y)) / 100;
}

// Photographs of plates with random numbers, places and poses.
struct Conditions {
  const char* family;
  double least_width, most_width;  // of the plate from the front [px]
  double haze;
  double most_error;  // root mean square [px]
};

void PrintTo(const Conditions& c, std::ostream* out) {
  *out << c.family << ", " << c.least_width << " px, haze " << c.haze;
}

class Plates : public testing::TestWithParam<Conditions> {};

// The bounds are those of the acceptance; the standard deviations must hold within a factor of 1.5.
TEST_P(Plates, AreFoundToASmallPartOfAPixel) {
  constexpr int kCount = 30;
  const Conditions& c = GetParam();
  const Family family = parse_family(c.family);
  const Numbers numbers = numbers_of(family);
  std::mt19937 random(3);
  int found = 0;
  double from_centre = 0, in_sigmas = 0;
  for (int i = 0; i < kCount; ++i) {
    PlateView view = random_view(random, c.least_width, c.most_width);
    for (double* light : {&view.white, &view.black, &view.background})
      *light = *light * (1 - c.haze) + 127 * c.haze;
    const std::size_t number = numbers.first + random() % (numbers.last - numbers.first + 1);
    const Pattern pattern(family, number);
    for (const Detection& target :
         find_targets(test::photograph(view, pattern), std::array{family})) {
      ASSERT_EQ(target.number, number);
      ++found;
      const Eigen::Vector2d measured =
          family.kind == Kind::ring ? centre_of_dot(view, pattern) : view.centre;
      from_centre += (target.centre.pixel - view.centre).squaredNorm() / 2;
      in_sigmas += ((target.centre.pixel - measured) / target.centre.sigma).squaredNorm() / 2;
    }
  }
  EXPECT_GE(found, kCount - (c.haze > 0 ? 2 : 1));
  EXPECT_LE(found, kCount);
  EXPECT_LT(std::sqrt(from_centre / found), c.most_error);
  EXPECT_GT(std::sqrt(in_sigmas / found), 1 / 1.5);
  EXPECT_LT(std::sqrt(in_sigmas / found), 1.5);
}

INSTANTIATE_TEST_SUITE_P(All, Plates,
                         testing::Values(Conditions{"circular12", 24, 50, 0, 0.1},
                                         Conditions{"circular12", 50, 150, 0, 0.1},
                                         Conditions{"circular14", 24, 50, 0.8, 0.25},
                                         Conditions{"circular20", 40, 80, 0, 0.1},
                                         Conditions{"APRILTAG_36h11", 24, 50, 0, 0.1},
                                         Conditions{"APRILTAG_36h11", 50, 150, 0, 0.1},
                                         Conditions{"4X4_50", 24, 50, 0.8, 0.25}));

// Errors that blocks of pixels share move an outline by more than independent errors of their size.
TEST(FindTargets, StandardDeviationsAllowForErrorsOfBlocks) {
  const Family family = parse_family("circular12");
  std::mt19937 random(5);
  std::normal_distribution<float> draw(0, 4);
  double in_sigmas = 0;
  int found = 0;
  for (int i = 0; i < 40; ++i) {
    PlateView view = random_view(random, 60, 90);
    view.noise = 0.5;
    const Pattern pattern(family, 7);
    cv::Mat1f photograph;
    test::photograph(view, pattern).convertTo(photograph, CV_32F);
    for (int y = 0; y < photograph.rows; y += 4)
      for (int x = 0; x < photograph.cols; x += 4) photograph(cv::Rect(x, y, 4, 4)) += draw(random);
    cv::Mat1b stored;
    photograph.convertTo(stored, CV_8U);
    for (const Detection& target : find_targets(stored, std::array{family})) {
      const Eigen::Vector2d off = target.centre.pixel - centre_of_dot(view, pattern);
      in_sigmas += (off / target.centre.sigma).squaredNorm() / 2;
      ++found;
    }
  }
  EXPECT_GE(found, 38);
  EXPECT_LT(std::sqrt(in_sigmas / found), 1.5);  // independent errors alone: 3.0
  EXPECT_GT(std::sqrt(in_sigmas / found), 0.6);
}

// A ring is not told from bare texture if the noise is a quarter of the step.
TEST(FindTargets, RingsInStrongNoiseAreNoTargets) {
  const Family family = parse_family("circular12");
  PlateView view;
  view.width = 80;
  const Pattern pattern(family, 30);
  EXPECT_EQ(find_targets(test::photograph(view, pattern), std::array{family}).size(), 1u);
  view.noise = 0.25 * (view.white - view.black);
  view.blur = 1.2;
  EXPECT_TRUE(find_targets(test::photograph(view, pattern), std::array{family}).empty());
}

TEST(FindTargets, ReadsBlackOnWhite) {
  const Family family = parse_family("circular12");
  const PlateView view;
  cv::Mat1b inverted;
  cv::bitwise_not(test::photograph(view, Pattern(family, 30)), inverted);
  const auto found = find_targets(inverted, std::array{family});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].number, 30u);
  EXPECT_LT((found[0].centre.pixel - view.centre).norm(), 0.05);
}

TEST(FindTargets, CornersAreThoseOfTheMarkerThatIsNotTurned) {
  const Family family = parse_family("4X4_50");
  const Pattern pattern(family, 7);
  for (const double turn : {0.1, 1.7, 3.2, 4.8}) {
    PlateView view;
    view.turn = turn;
    const auto found = find_targets(test::photograph(view, pattern), std::array{family});
    ASSERT_EQ(found.size(), 1u);
    const double half = pattern.half_marker();
    const std::array<Eigen::Vector2d, 4> corners{
        {{-half, -half}, {half, -half}, {half, half}, {-half, half}}};
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_LT(((*found[0].corners)[k].pixel - test::image_of(view, pattern, corners[k])).norm(),
                0.2);
  }
}

// Noise with structure of all sizes, as of a seabed: the sum of smoothed noise.
cv::Mat1b seabed(unsigned seed) {
  std::mt19937 random(seed);
  cv::Mat1f sum(480, 640, 0.f);
  for (double size = 1; size < 60; size *= 2) {
    cv::Mat1f noise(sum.size());
    std::normal_distribution<float> normal(0, static_cast<float>(40 * size));
    for (float& value : noise) value = normal(random);
    cv::GaussianBlur(noise, noise, {}, size);
    sum += noise;
  }
  cv::Mat1b picture;
  sum.convertTo(picture, CV_8U, 1, 110);
  return picture;
}

TEST(FindTargets, PhotographsWithoutPlatesHaveNoTargets) {
  const auto families = parse_families("circular12,4X4_50");
  for (unsigned seed = 0; seed < 20; ++seed)
    EXPECT_TRUE(find_targets(seabed(seed), families).empty()) << seed;
}

TEST(FindTargets, APlateThatIsCutOffOrCoveredIsNotFound) {
  const auto families = parse_families("circular12,4X4_50");
  for (const Family& family : families) {
    PlateView view;
    const cv::Mat1b whole = test::photograph(view, Pattern(family, 5));
    ASSERT_EQ(find_targets(whole, families).size(), 1u);
    EXPECT_TRUE(find_targets(whole.colRange(0, 170), families).empty());
    cv::Mat1b covered = whole.clone();
    cv::circle(covered, {170, 128}, 12, {90}, cv::FILLED);
    EXPECT_TRUE(find_targets(covered, families).empty());
  }
}

// A photograph whose 16 bits use 12, with a broken pixel.
TEST(FindTargets, ReadsDarkPhotographsOf16Bits) {
  for (const char* name : {"circular12", "4X4_50"}) {
    const Family family = parse_family(name);
    const PlateView view;
    cv::Mat1w dark;
    test::photograph(view, Pattern(family, 30)).convertTo(dark, CV_16U, 4);
    dark(3, 3) = 65535;
    const auto found = find_targets(dark, std::array{family});
    ASSERT_EQ(found.size(), 1u) << name;
    EXPECT_LT((found[0].centre.pixel - view.centre).norm(), 0.05);
  }
}

// A fit to one brightness has no outline.
TEST(FindTargets, PicturesWithoutContrastAreSearched) {
  const auto families = parse_families("circular12,4X4_50");
  for (const cv::Size& size : {cv::Size(1, 1), cv::Size(3, 200), cv::Size(100, 100)})
    for (const double value : {0.0, 128.0, 255.0})
      EXPECT_TRUE(
          find_targets(cv::Mat1b(size, cv::saturate_cast<std::uint8_t>(value)), families).empty());
}

}  // namespace
}  // namespace axial::targets
