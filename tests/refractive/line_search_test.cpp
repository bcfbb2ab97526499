// SPDX-License-Identifier: GPL-3.0-or-later
#include "refractive/line_search.h"

#include <gtest/gtest.h>

#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

struct RoundTrip {
  double mean = 0, largest = 0;
  int inside = 0, missed = 0;
};

// Measures the round trip from random positions in the image's area, as in the paper's figure 2.
// The positions are not rounded to pixel centres.
RoundTrip measure(const LineSearchCamera<double>& camera, int width, int height, Random& random) {
  RoundTrip result;
  for (int k = 0; k < 5000; ++k) {
    const Vector2<double> pixel(random.uniform(-0.5, width - 0.5),
                                random.uniform(-0.5, height - 0.5));
    const auto X = random_point(random, camera.exact(), pixel);
    if (!X) continue;
    const Projection<double> image = camera.project(*X);
    ++result.inside;
    if (!image.visible) {
      ++result.missed;
      continue;
    }
    const double error = (image.pixel - pixel).norm();
    result.mean += error;
    result.largest = std::max(result.largest, error);
  }
  result.mean /= result.inside - result.missed;
  return result;
}

void expect_papers_error(double fov, double distance, double tilt) {
  Random random(71);
  const int size = 1000;
  const LineSearchCamera<double> camera(lens_with_fov(fov, size, size), paper_port(distance, tilt),
                                        size, size);
  const RoundTrip result = measure(camera, size, size, random);
  report("Algorithm 1, mean round trip [px]", result.mean);
  // "About a quarter of a pixel" in the paper, 0.267 to 0.271 px in docs/evaluation.md.
  EXPECT_GT(result.mean, 0.24) << fov << ' ' << distance << ' ' << tilt;
  EXPECT_LT(result.mean, 0.29) << fov << ' ' << distance << ' ' << tilt;
  EXPECT_LT(result.largest, 1.1);
  // Points can be missed within 0.27 px of the border of the 1000 px wide image, on each of four
  // sides; about half of these points are. The limit is about twice this number, for chance. The
  // printed border rule would miss about 0.15 % more.
  EXPECT_LT(result.missed, 0.0015 * result.inside);
}

TEST(LineSearch, MeanErrorOverFieldsOfView) {
  for (const double fov : {40, 80, 120}) expect_papers_error(fov, 0.02, 0);
}

TEST(LineSearch, MeanErrorOverDistances) {
  for (const double distance : {0.001, 0.01, 0.1}) expect_papers_error(80, distance, 0);
}

TEST(LineSearch, MeanErrorOverTilts) {
  for (const double tilt : {6, 12, 20}) expect_papers_error(80, 0.02, tilt);
}

TEST(LineSearch, ReturnsThePinholeImageOnTheAxis) {
  const LineSearchCamera<double> camera(lens_with_fov(80, 200, 150), paper_port(0.02, 5), 200, 150);
  const Vector3<double> X = 1.7 * camera.port().normal;
  const Projection<double> image = camera.project(X);
  EXPECT_TRUE(image.visible);
  EXPECT_LT((image.pixel - camera.exact().project(X).pixel).norm(), 1e-3);
}

TEST(LineSearch, SeesNothingBehindThePortOrBad) {
  const LineSearchCamera<float> camera(lens_with_fov(80, 200, 150).cast<float>(),
                                       paper_port().cast<float>(), 200, 150);
  for (const Vector3<float>& X :
       {Vector3<float>(0, 0, 0.03f), Vector3<float>(0.1f, 0, -1), Vector3<float>(0, NAN, 1),
        Vector3<float>(0.1f, 0.1f, INFINITY), Vector3<float>(NAN, NAN, NAN)}) {
    Matrix23<float> jacobian;
    const Projection<float> image = camera.project(X, &jacobian);
    EXPECT_FALSE(image.visible) << X.transpose();
    EXPECT_TRUE(image.pixel.allFinite() && jacobian.allFinite());
  }
}

// A point whose image is more than about a pixel outside the image must not be visible.
TEST(LineSearch, SeesNothingOutsideTheImage) {
  Random random(72);
  for (int k = 0; k < 20; ++k) {
    const View view = random_view(random, 120, 90);
    const LineSearchCamera<double> camera(view.lens, view.port, view.width, view.height);
    for (int i = 0; i < 500; ++i) {
      const Vector3<double> X = random.unit_vector() * random.log_uniform(0.2, 10);
      const Projection<double> image = camera.project(X);
      if (!image.visible) continue;
      const Projection<double> exact = camera.exact().project(X);
      ASSERT_TRUE(exact.visible);
      EXPECT_LT((exact.pixel - image.pixel).norm(), 1.1);
    }
  }
}

TEST(LineSearch, WorksInTheSmallestImages) {
  for (int size = 1; size < 4; ++size) {
    const LineSearchCamera<double> camera({3, 3, 0.5 * (size - 1), 0.5 * (size - 1)}, paper_port(),
                                          size, size);
    for (int u = 0; u < size; ++u) {
      const Vector2<double> pixel(u, size - 1 - u);
      const Projection<double> image = camera.project(camera.ray(pixel).at(1));
      EXPECT_TRUE(image.visible);
      EXPECT_LT((image.pixel - pixel).norm(), 1);
    }
  }
}

// The port's normal is perpendicular to the optical axis, so that x_n does not exist.
TEST(LineSearch, NeedsNoFootOfTheAxisInTheImage) {
  const FlatPort<double> port{tilted_normal(90 * kDegree, 0), 0.02, 0.014, 1, 1.52, 1.333};
  const LineSearchCamera<double> camera(lens_with_fov(100, 400, 300), port, 400, 300);
  Random random(73);
  for (int k = 0; k < 500; ++k) {
    const Vector2<double> pixel(random.uniform(260, 395), random.uniform(5, 295));
    const Projection<double> image = camera.project(camera.ray(pixel).at(2));
    EXPECT_TRUE(image.visible);
    EXPECT_LT((image.pixel - pixel).norm(), 1.1);
  }
}

TEST(ClipRay, AgreesWithWalkingTheRay) {
  Random random(74);
  const Vector2<double> low(-1, -1);
  const Vector2<double> high(10, 8);
  for (int k = 0; k < 2000; ++k) {
    const Vector2<double> start(random.uniform(-20, 30), random.uniform(-20, 30));
    Vector2<double> step(random.uniform(-1, 1), random.uniform(-1, 1));
    if (k % 10 == 0) step.x() = 0;
    if (k % 11 == 0) step.y() = 0;
    double first = -1;
    double last = -1;
    const double dt = 0.01 / step.norm();
    if (step.norm() > 0) {
      for (double t = 0; t * step.norm() < 60; t += dt) {
        const Vector2<double> x = start + t * step;
        if ((x.array() < low.array()).any() || (x.array() > high.array()).any()) continue;
        if (first < 0) first = t;
        last = t;
      }
    }
    const auto segment = clip_ray(start, step, low, high);
    if (first >= 0) {
      ASSERT_TRUE(segment);
      EXPECT_LT((segment->start - (start + first * step)).norm(), 0.011);
      EXPECT_LT((segment->end - (start + last * step)).norm(), 0.011);
    } else if (segment) {  // a corner cut between two steps of the walk
      EXPECT_LT((segment->end - segment->start).norm(), 0.011);
    }
  }
}

TEST(ClipRay, RefusesNan) {
  EXPECT_FALSE(clip_ray<double>({NAN, 1}, {1, 1}, {0, 0}, {5, 5}));
  EXPECT_FALSE(clip_ray<double>({1, 1}, {NAN, 1}, {0, 0}, {5, 5}));
  EXPECT_FALSE(clip_ray<double>({1, 1}, {1, NAN}, {0, 0}, {5, 5}));
  EXPECT_FALSE(clip_ray<double>({1, 1}, {0, 0}, {0, 0}, {5, 5}));
}

}  // namespace
}  // namespace axial::refractive::testing
