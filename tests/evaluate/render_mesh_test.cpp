// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/render_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "evaluate/report.h"
#include "evaluate/shapes.h"
#include "simulate/render.h"
#include "support/error_of.h"
#include "worlds/ports.h"

namespace axial::evaluate {
namespace {

using testing::HasSubstr;

constexpr double kAbove = 1;  // height of the camera above the ground [m]

// A camera of 80 x 60 pixels that looks down at the ground z = 0.
View looking_down() {
  return {test::camera_above({0, 0, kAbove}, 80, 60, 70), "a.jpg"};
}

// The ground of 2 m x 2 m with a texture of 200 x 200 texels. The texel at the column x and the row
// y shows the centre of the square with x from -1 + 0.01 x to -1 + 0.01 (x + 1), and y likewise.
TexturedMesh ground(const std::function<cv::Vec3b(int x, int y)>& texel) {
  TexturedMesh ground;
  ground.mesh = flat_square(2, 0);
  cv::Mat3b& texture = ground.textures.emplace_back(200, 200);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) texture(y, x) = texel(x, y);
  for (const auto& face : ground.mesh.faces) {
    TexturedMesh::Corners uv;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f& vertex = ground.mesh.vertices[face[k]];
      uv[k] = {(vertex.x() + 1) * 100 - 0.5f, (vertex.y() + 1) * 100 - 0.5f};
    }
    ground.uv.push_back(uv);
    ground.texture_of.push_back(0);
  }
  return ground;
}

// Ramps: blue grows along x, green along y. Linear colours are the same after interpolation and
// after averaging.
TexturedMesh ramps() {
  return ground([](int x, int y) {
    return cv::Vec3b(static_cast<std::uint8_t>(x + 20), static_cast<std::uint8_t>(y + 20), 7);
  });
}

cv::Vec3d ramp_at(double x, double y) {
  return {(x + 1) * 100 - 0.5 + 20, (y + 1) * 100 - 0.5 + 20, 7};
}

RenderedView rendered(const TexturedMesh& mesh, const View& view,
                      const RenderOptions& options = {}) {
  return render_mesh(geometry::Surface(mesh.mesh), texture_coloring(mesh), view, options);
}

// The largest difference to the colours that the ramps have at scale(tangent of the angle in air)
// times the direction of the pixel.
double largest_error(const cv::Mat3b& image, const View& view,
                     const std::function<double(double)>& scale) {
  double largest = 0;
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u) {
      const double x = (u - view.camera.lens.cx) / view.camera.lens.fx;
      const double y = (v - view.camera.lens.cy) / view.camera.lens.fy;
      const double s = scale(std::hypot(x, y));
      const cv::Vec3d expected = ramp_at(s * x, -s * y);
      for (int c = 0; c < 3; ++c)
        largest = std::max(largest, std::abs(expected[c] - image(v, u)[c]));
    }
  return largest;
}

TEST(RenderMesh, ATexturedPlaneHasTheImageOfAPinhole) {
  const View view = looking_down();
  const RenderedView picture = rendered(ramps(), view);
  // The picture is rounded to whole grey levels.
  EXPECT_LE(largest_error(picture.image, view, [](double) { return kAbove; }), 0.51);
  EXPECT_EQ(cv::countNonZero(picture.covered), 80 * 60);
  EXPECT_EQ(cv::countNonZero(picture.known), 80 * 60);
}

TEST(RenderMesh, BehindAFlatPortTheImageFollowsSnellsLaw) {
  View view = looking_down();
  constexpr double kDistance = 0.03, kThickness = 0.02, kGlass = 1.5, kWater = 1.333;
  view.camera.port =
      refractive::FlatPort<double>{{0, 0, 1}, kDistance, kThickness, 1, kGlass, kWater};
  const auto tangent = [](double sine) { return sine / std::sqrt(1 - sine * sine); };
  const auto scale = [&](double air) -> double {
    if (air == 0) return kAbove;
    const double sine = air / std::hypot(1, air);
    const double radius = kDistance * air + kThickness * tangent(sine / kGlass) +
                          (kAbove - kDistance - kThickness) * tangent(sine / kWater);
    return radius / air;
  };
  const cv::Mat3b image = rendered(ramps(), view).image;
  // Rounding, and the curvature of the ramps within a pixel, which is less than 0.1 grey levels.
  EXPECT_LE(largest_error(image, view, scale), 0.6);
  EXPECT_GT(largest_error(image, view, [](double) { return kAbove; }), 10);
}

TEST(RenderMesh, APixelIsTheMeanOfItsFootprint) {
  View view = looking_down();
  // A pixel is two texels wide, and its centre is that of a texel.
  view.camera.lens = {50, 50, 39.75, 29.75};
  const TexturedMesh stripes =
      ground([](int x, int) { return x % 2 == 0 ? cv::Vec3b(0, 0, 0) : cv::Vec3b(200, 200, 200); });
  const auto worst = [&](int samples) {
    const cv::Mat3b image = rendered(stripes, view, {samples}).image;
    double largest = 0;
    for (const cv::Vec3b& bgr : image) largest = std::max(largest, std::abs(bgr[0] - 100.0));
    return largest;
  };
  EXPECT_EQ(worst(1), 100);
  // The rays are 2/3 of a texel apart: (200 + 2 * 200 / 3) / 3 = 111 or (0 + 2 * 400 / 3) / 3 = 89.
  EXPECT_LE(worst(3), 11.6);
  EXPECT_LE(worst(16), 1);
}

// The simulator traces light by code of its own.
TEST(RenderMesh, EveryCameraSeesWhatTheSimulatorSees) {
  const Mesh seabed = height_field(12, 2, ripples);
  std::vector<Rgb> colors;
  for (std::size_t i = 0; i < seabed.vertices.size(); ++i)
    colors.push_back({static_cast<std::uint8_t>(37 * i % 251),
                      static_cast<std::uint8_t>(91 * i % 241), static_cast<std::uint8_t>(i % 239)});
  const simulate::RayScene scene({seabed.vertices, seabed.faces});
  const Coloring coloring = vertex_coloring(seabed.faces, colors);
  const auto shade = [&](const simulate::SurfacePoint& point) -> Eigen::Vector3f {
    return coloring({point.hit.face, point.hit.u, point.hit.v}).bgr.reverse() / 255;
  };
  simulate::Lens lens = simulate::make_lens(80, 60, 60);
  simulate::Port flat;
  flat.normal = simulate::tilted_normal(5);
  flat.distance = 0.03, flat.thickness = 0.01, flat.n_glass = 1.5, flat.n_water = 1.333;
  simulate::Port dome = flat;
  dome.dome = simulate::Dome{{0.004, -0.003, 0.006}, 0.05};
  View view = looking_down();
  view.camera.lens = {lens.focal, lens.focal, lens.cx, lens.cy};
  const auto check = [&](const char* name, const simulate::Port* port) {
    const cv::Mat3b expected =
        simulate::develop(simulate::render_radiance(scene, shade, lens, port,
                                                    {view.pose.rotation, view.pose.centre}, 3),
                          0, 0);
    const RenderedView picture = render_mesh(geometry::Surface(seabed), coloring, view);
    EXPECT_EQ(cv::countNonZero(picture.covered), 80 * 60) << name;
    // Sums in another order are rounded differently.
    EXPECT_LE(cv::norm(picture.image, expected, cv::NORM_INF), 1) << name;
  };
  check("air", nullptr);
  view.camera.port = refractive::FlatPort<double>{flat.normal, flat.distance, flat.thickness,
                                                  flat.n_air,  flat.n_glass,  flat.n_water};
  check("flat port", &flat);
  view.camera.port = refractive::DomePort<double>{dome.dome->centre, dome.dome->inner_radius,
                                                  dome.thickness,    dome.n_air,
                                                  dome.n_glass,      dome.n_water};
  check("dome", &dome);
}

TEST(RenderMesh, WhatTheMeshDoesNotCoverIsBackground) {
  const View view = looking_down();
  // Of the ground, the pixel columns 25.5 to 53.5 and the rows 15.5 to 43.5 see 0.4 m x 0.4 m.
  Mesh mesh = flat_square(0.4, 0);
  mesh.colors.assign(mesh.vertices.size(), {10, 20, 30});
  const RenderedView picture =
      render_mesh(geometry::Surface(mesh), vertex_coloring(mesh.faces, mesh.colors), view);
  for (int v = 0; v < 60; ++v)
    for (int u = 0; u < 80; ++u) {
      const bool inside = u >= 26 && u <= 53 && v >= 16 && v <= 43;
      EXPECT_EQ(picture.covered(v, u) != 0, inside) << u << " " << v;
      EXPECT_EQ(picture.known(v, u) != 0, inside) << u << " " << v;
      EXPECT_EQ(picture.image(v, u), inside ? cv::Vec3b(30, 20, 10) : cv::Vec3b(255, 255, 255));
    }
  EXPECT_EQ(cv::norm(picture.covered, covered_pixels(geometry::Surface(mesh), view), cv::NORM_INF),
            0);
}

TEST(RenderMesh, TheNearerSurfaceHidesTheFartherOne) {
  Mesh mesh = flat_square(2, 0);
  const Mesh upper = flat_square(0.2, 0.5);
  mesh.colors.assign(mesh.vertices.size(), {200, 0, 0});
  append(mesh, upper);
  mesh.colors.resize(mesh.vertices.size(), {0, 0, 200});
  const cv::Mat3b image =
      render_mesh(geometry::Surface(mesh), vertex_coloring(mesh.faces, mesh.colors), looking_down())
          .image;
  EXPECT_EQ(image(30, 40), cv::Vec3b(200, 0, 0));
  EXPECT_EQ(image(5, 5), cv::Vec3b(0, 0, 200));
}

TEST(RenderMesh, FacesWithoutPhotographHaveNoKnownColour) {
  TexturedMesh mesh = ramps();
  mesh.uv[0] = {mesh.uv[0][0], mesh.uv[0][0], mesh.uv[0][0]};
  const RenderedView picture = rendered(mesh, looking_down());
  EXPECT_EQ(cv::countNonZero(picture.covered), 80 * 60);
  // The diagonal between the two faces halves the image.
  EXPECT_NEAR(cv::countNonZero(picture.known), 80 * 60 / 2, 100);
}

TEST(RenderMesh, AnyNumberOfThreadsGivesTheSamePicture) {
  const TexturedMesh mesh = ramps();
  const cv::Mat3b many = rendered(mesh, looking_down()).image;
  const ThreadLimit one(1);
  EXPECT_EQ(cv::norm(many, rendered(mesh, looking_down()).image, cv::NORM_INF), 0);
}

TEST(RenderMesh, WrongInputIsRefused) {
  const auto error = [](auto change) {
    TexturedMesh mesh = ramps();
    RenderOptions options;
    change(mesh, options);
    return test::error_of([&] { rendered(mesh, looking_down(), options); });
  };
  EXPECT_THAT(error([](auto&, auto& options) { options.samples = 0; }), HasSubstr("samples is 0"));
  EXPECT_THAT(error([](auto&, auto& options) { options.samples = 17; }), HasSubstr("samples is"));
  EXPECT_THAT(error([](auto& mesh, auto&) { mesh.texture_of[1] = 1; }), HasSubstr("texture 1"));
  EXPECT_THAT(error([](auto& mesh, auto&) { mesh.uv.pop_back(); }), HasSubstr("1 texture coord"));
  const Mesh mesh = flat_square(1, 0);
  const std::vector<Rgb> three(3);
  EXPECT_THAT(test::error_of([&] { vertex_coloring(mesh.faces, three); }),
              HasSubstr("vertex 3 of the mesh has no colour"));
}

TEST(ComparePictures, PsnrOfAKnownDifference) {
  const cv::Mat3b grey(10, 20, cv::Vec3b(100, 100, 100));
  cv::Mat3b noisy = grey.clone();
  for (int v = 0; v < 10; ++v)
    for (int u = 0; u < 20; ++u)
      noisy(v, u) += (u + v) % 2 == 0 ? cv::Vec3b(5, 5, 5) : cv::Vec3b(0, 0, 0);
  cv::Mat1b mask(10, 20, std::uint8_t{1});
  PictureDifference difference = compare_pictures(noisy, grey, mask);
  EXPECT_EQ(difference.pixels, 200u);
  EXPECT_DOUBLE_EQ(difference.mean(), 2.5);
  EXPECT_NEAR(difference.psnr(), 10 * std::log10(255 * 255 / 12.5), 1e-9);
  // Pixels outside the mask do not count.
  noisy(0, 0) = {255, 0, 0};
  mask(0, 0) = 0;
  const PictureDifference masked = compare_pictures(noisy, grey, mask);
  EXPECT_EQ(masked.pixels, 199u);
  EXPECT_DOUBLE_EQ(masked.squared_sum, 99 * 3 * 25);
  difference += masked;
  EXPECT_EQ(difference.pixels, 399u);
  EXPECT_NEAR(difference.psnr(), 10 * std::log10(255 * 255 * 399 / (199 * 25.0)), 1e-9);
  EXPECT_TRUE(std::isinf(compare_pictures(grey, grey, mask).psnr()));
  EXPECT_TRUE(std::isnan(compare_pictures(grey, grey, cv::Mat1b(10, 20, std::uint8_t{0})).psnr()));
  EXPECT_THAT(test::error_of([&] { compare_pictures(grey, cv::Mat3b(20, 10), mask); }),
              HasSubstr("20 x 10 and 10 x 20"));
}

TEST(RenderReport, ViewsAndTheirPixelsTogether) {
  ViewReport first, second;
  first.view = "a.jpg", second.view = "b.jpg";
  first.covered = 0.5;
  std::vector<ViewReport> views{first, second};
  nlohmann::ordered_json json = to_json(views);
  EXPECT_EQ(json["views"][0]["covered"], 0.5);
  EXPECT_FALSE(json["views"][0].contains("psnr"));
  EXPECT_FALSE(json.contains("psnr"));
  views[0].difference = PictureDifference{100, 300 * 100.0, 300 * 8.0};
  views[1].difference = PictureDifference{300, 0, 0};
  json = to_json(views);
  EXPECT_NEAR(json["views"][0]["psnr"].get<double>(), 10 * std::log10(255 * 255 / 100.0), 1e-9);
  EXPECT_EQ(json["views"][1]["psnr"], nullptr);
  EXPECT_NEAR(json["psnr"].get<double>(), 10 * std::log10(255 * 255 / 25.0), 1e-9);
  EXPECT_EQ(json["mean_difference"], 2.0);
  EXPECT_THAT(table(std::span<const ViewReport>(views)), HasSubstr("all views"));
}

}  // namespace
}  // namespace axial::evaluate
