// SPDX-License-Identifier: GPL-3.0-or-later
// Draws photographs of a checkerboard behind a flat port, by the ray tracer of libs/simulate.
// Usage:
//
//     drawn_boards SEED FOLDER
//
// Every second photograph shows the whole board. In the others, the border of the photograph or a
// disc hides a part of it. Lens, port, poses, discs, haze and noise depend on SEED. FOLDER gets the
// photographs (photos/*.png), the lens in air (lens.txt) and the port as measured by a ruler
// (start.json). Prints one line of JSON: "right" and "down", the angles of the normal [degrees];
// "distance" [mm]; "photographs", the number of photographs that show three by four neighbouring
// corners or more.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/parse_number.h"
#include "check_program.h"
#include "io/bytes/json.h"
#include "io/cameras/housing.h"
#include "io/images/image.h"
#include "simulate/optics.h"

namespace {

using namespace axial;
using simulate::kRadians;

constexpr int kColumns = 8, kRows = 7;  // inner corners
constexpr double kSquare = 0.03;        // [m]
constexpr int kPhotographs = 14;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  // Not std::uniform_real_distribution: its numbers depend on the standard library.
  double operator()(double low, double high) {
    constexpr double kRange = 4294967296.0;
    return low + (high - low) * (static_cast<double>(engine_()) / kRange);
  }
  unsigned seed() { return static_cast<unsigned>(engine_()); }

 private:
  std::mt19937 engine_;
};

struct Camera {
  simulate::Lens lens;
  simulate::Port port;
  simulate::View view;

  // The place on the plane of the board that a pixel shows.
  std::optional<Eigen::Vector2d> on_board(double u, double v) const {
    const auto in_camera = simulate::trace_pixel(lens, &port, u, v);
    if (!in_camera) return {};
    const simulate::SceneRay ray = simulate::to_world(view, *in_camera);
    const double along = -ray.start.z() / ray.direction.z();
    if (!(along > 0)) return {};
    return (ray.start + along * ray.direction).head<2>();
  }
};

double brightness(const Eigen::Vector2d& at) {
  const double column = std::floor(at.x() / kSquare), row = std::floor(at.y() / kSquare);
  if (column < -2 || row < -2 || column > kColumns || row > kRows) return 0.4;        // ground
  if (column < -1 || row < -1 || column > kColumns - 1 || row > kRows - 1) return 1;  // margin
  return std::fmod(std::abs(column + row), 2) == 0 ? 0 : 1;
}

// The mean of 5 x 5 rays where the corners of the pixel differ.
double pixel_value(const Camera& camera, int x, int y) {
  constexpr int kSide = 5;
  const auto sample = [&](int i, int j) {
    const auto place = camera.on_board(x - 0.5 + (i + 0.5) / kSide, y - 0.5 + (j + 0.5) / kSide);
    return place ? brightness(*place) : 0;
  };
  const double first = sample(0, 0);
  if (sample(kSide - 1, 0) == first && sample(0, kSide - 1) == first &&
      sample(kSide - 1, kSide - 1) == first)
    return first;
  double sum = 0;
  for (int k = 0; k < kSide * kSide; ++k) sum += sample(k % kSide, k / kSide);
  return sum / (kSide * kSide);
}

// The pixel that shows a corner, by Newton's method. Empty if there is none.
std::optional<Eigen::Vector2d> pixel_of(const Camera& camera, const Eigen::Vector2d& corner) {
  Eigen::Vector2d pixel(camera.lens.cx, camera.lens.cy);
  constexpr int kSteps = 30;
  for (int step = 0; step < kSteps; ++step) {
    const auto here = camera.on_board(pixel.x(), pixel.y());
    const auto right = camera.on_board(pixel.x() + 0.5, pixel.y());
    const auto below = camera.on_board(pixel.x(), pixel.y() + 0.5);
    if (!here || !right || !below) return {};
    Eigen::Matrix2d slope;
    slope << 2 * (*right - *here), 2 * (*below - *here);
    const Eigen::Vector2d move = slope.inverse() * (corner - *here);
    if (!move.allFinite()) return {};
    pixel += move * std::min(1.0, 100 / move.norm());  // at most 100 pixels
    if (move.norm() < 1e-6) return pixel;
  }
  return {};
}

struct Disc {
  Eigen::Vector2d middle{0, 0};
  double radius = 0, grey = 0;  // radius 0: no disc
};

// The corners in the photograph, row by row; far outside where a corner has no pixel.
using Corners = std::array<Eigen::Vector2d, kColumns * kRows>;

Corners corners_of(const Camera& camera) {
  Corners corners;
  for (int i = 0; i < kColumns * kRows; ++i)
    corners[static_cast<std::size_t>(i)] =
        pixel_of(camera, kSquare * Eigen::Vector2d(i % kColumns, i / kColumns))
            .value_or(Eigen::Vector2d(-1e6, -1e6));
  return corners;
}

double spacing_at(const Corners& corners, std::size_t i) {
  double least = 1e9;
  for (std::size_t j = 0; j < corners.size(); ++j)
    if (j != i) least = std::min(least, (corners[j] - corners[i]).norm());
  return least;
}

// Whether each corner is visible with a third of a square around it.
cv::Mat1b visible(const Corners& corners, const Disc& disc, const simulate::Lens& lens) {
  cv::Mat1b result(kRows, kColumns);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double margin = spacing_at(corners, i) / 3;
    const Eigen::Vector2d& at = corners[i];
    result(static_cast<int>(i)) =
        at.x() >= margin && at.y() >= margin && at.x() <= lens.width - 1 - margin &&
        at.y() <= lens.height - 1 - margin && (at - disc.middle).norm() >= disc.radius + margin;
  }
  return result;
}

bool holds_piece(const cv::Mat1b& seen) {
  for (const cv::Size size : {cv::Size(3, 4), cv::Size(4, 3)})
    for (int y = 0; y + size.height <= kRows; ++y)
      for (int x = 0; x + size.width <= kColumns; ++x)
        if (cv::countNonZero(seen(cv::Rect({x, y}, size))) == size.area()) return true;
  return false;
}

// A view in which the middle of the board has a random place; nearer to the border for larger
// `aside`.
simulate::View random_view(Random& random, double nearest, double farthest, double aside) {
  const double z = random(nearest, farthest), axis = random(0, 360) * kRadians;
  const double x = random(-aside, aside) * z, y = 0.75 * random(-aside, aside) * z;
  const double tilt = random(5, 40) * kRadians, turn = random(-180, 180) * kRadians;
  simulate::View view;
  view.rotation = (Eigen::AngleAxisd(tilt, Eigen::Vector3d(std::cos(axis), std::sin(axis), 0)) *
                   Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))
                      .toRotationMatrix();
  const Eigen::Vector3d middle(kSquare * (kColumns - 1) / 2, kSquare * (kRows - 1) / 2, 0);
  view.centre = middle - view.rotation.transpose() * Eigen::Vector3d(x, y, z);
  return view;
}

Disc random_disc(Random& random, const Corners& corners) {
  Disc disc;
  disc.middle = corners[static_cast<std::size_t>(random(0, kColumns * kRows))];
  disc.radius = random(0.5, 3) * spacing_at(corners, kColumns * kRows / 2);
  disc.grey = random(0, 1);
  return disc;
}

enum class Shown { whole, cut, covered };

// Sets the view of `camera`, and returns the disc, so that the board is shown as `shown` says.
Disc place(Random& random, Shown shown, Camera& camera) {
  const bool cut = shown == Shown::cut;
  for (;;) {
    camera.view = cut ? random_view(random, 0.2, 0.35, 0.5) : random_view(random, 0.35, 0.6, 0.4);
    const Corners corners = corners_of(camera);
    const int seen = cv::countNonZero(visible(corners, {}, camera.lens));
    constexpr int kAll = kColumns * kRows, kLeast = 4;
    if (cut ? seen < kLeast || seen == kAll : seen < kAll) continue;
    return shown == Shown::covered ? random_disc(random, corners) : Disc();
  }
}

cv::Mat1b photograph(const Camera& camera, const Disc& disc, Random& random) {
  cv::Mat1f image(camera.lens.height, camera.lens.width);
  parallel_for(static_cast<std::size_t>(image.rows), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < image.cols; ++x) {
      const double hidden = disc.radius + 0.5 - (Eigen::Vector2d(x, y) - disc.middle).norm();
      const double share = disc.radius > 0 ? std::clamp(hidden, 0.0, 1.0) : 0.0;
      const double board = share < 1 ? pixel_value(camera, x, y) : 0;
      image(y, x) = static_cast<float>((1 - share) * board + share * disc.grey);
    }
  });
  const double contrast = random(0.3, 0.9), blur = random(0.4, 1);
  cv::GaussianBlur(image, image, {}, blur);
  cv::Mat1f noise(image.size());
  cv::RNG generator(random.seed());
  generator.fill(noise, cv::RNG::NORMAL, 0, random(1, 5));
  cv::Mat1b result;
  cv::Mat1f(255 * (contrast * image + (1 - contrast) * 0.4) + noise).convertTo(result, CV_8U);
  return result;
}

Camera random_camera(Random& random) {
  Camera camera;
  camera.lens = simulate::make_lens(640, 480, random(70, 90));
  const double tilt = random(0, 2.5) * kRadians, way = random(0, 360) * kRadians;
  camera.port.normal = {std::sin(tilt) * std::cos(way), std::sin(tilt) * std::sin(way),
                        std::cos(tilt)};
  camera.port.distance = random(0.01, 0.04);
  camera.port.thickness = 0.01;
  camera.port.n_glass = 1.49;
  camera.port.n_water = 1.34;
  return camera;
}

void write_camera(const std::filesystem::path& folder, const Camera& camera, double distance) {
  const simulate::Lens& lens = camera.lens;
  write_atomically(folder / "lens.txt",
                   fmt::format("1 PINHOLE {} {} {} {} {} {}\n", lens.width, lens.height, lens.focal,
                               lens.focal, lens.cx + 0.5, lens.cy + 0.5));
  const simulate::Port& port = camera.port;
  const refractive::FlatPort<double> start{{0, 0, 1},  distance,     port.thickness,
                                           port.n_air, port.n_glass, port.n_water};
  io::write_housing(folder / "start.json", io::housing_with(io::to_housing_port(start)));
}

int run(int, char** argv) {
  const auto seed = parse_number<unsigned>(argv[1]);
  if (!seed) fail("SEED {}: must be a whole number", argv[1]);
  const std::filesystem::path folder = argv[2];
  std::filesystem::create_directories(folder / "photos");
  Random random(*seed);
  Camera camera = random_camera(random);
  write_camera(folder, camera, camera.port.distance + random(-0.005, 0.005));
  int pieces = 0;
  for (int i = 0; i < kPhotographs; ++i) {
    const Shown shown = i % 2 == 0 ? Shown::whole : i % 4 == 1 ? Shown::cut : Shown::covered;
    const Disc disc = place(random, shown, camera);
    pieces += holds_piece(visible(corners_of(camera), disc, camera.lens));
    io::write_png(folder / "photos" / fmt::format("{:02}.png", i),
                  photograph(camera, disc, random));
  }
  const Eigen::Vector3d& normal = camera.port.normal;
  std::cout << io::to_text(nlohmann::json{{"right", std::atan2(normal.x(), normal.z()) / kRadians},
                                          {"down", std::atan2(normal.y(), normal.z()) / kRadians},
                                          {"distance", 1e3 * camera.port.distance},
                                          {"photographs", pieces}})
            << "\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return axial::check_program(argc, argv, 2, 2, "drawn_boards SEED FOLDER", run);
}
