// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/plates.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "base/error.h"
#include "simulate/noise.h"

namespace axial::simulate {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kSlab = 0.004;                  // thickness [m]
constexpr float kWhite = 0.75f, kBlack = 0.06f;  // reflectances
constexpr double kLeastGap = 1.6;                // between centres of plates, in sides
constexpr double kMostSlope = 0.6;               // of the ground under a plate, rise by run

// `place` as in Plate::white.
Eigen::Vector3d point_on(const Plate& plate, const Eigen::Vector2d& place) {
  return plate.centre + plate.side / 2 * (plate.axes.leftCols<2>() * place);
}

// The corners of the upper side, for a reader from the upper left one clockwise.
std::array<Eigen::Vector3d, 4> corners_of(const Plate& plate) {
  return {point_on(plate, {-1, -1}), point_on(plate, {1, -1}), point_on(plate, {1, 1}),
          point_on(plate, {-1, 1})};
}

// The centre, the corners (clockwise for a reader), and places between them.
std::vector<Eigen::Vector2d> places_on_plate() {
  constexpr int kSteps = 8;
  std::vector<Eigen::Vector2d> places{{0, 0}, {-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int i = 0; i <= kSteps; ++i)
    for (int k = 0; k <= kSteps; ++k)
      places.emplace_back(2.0 * i / kSteps - 1, 2.0 * k / kSteps - 1);
  return places;
}

// Random numbers in the order in which they are asked for.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : seed_(seed) {}
  double between(double low, double high) { return low + (high - low) * uniform(seed_, count_++); }

 private:
  std::uint64_t seed_, count_ = 0;
};

// The point of the ground that a random pixel in the middle of a random view shows.
std::optional<Eigen::Vector3d> random_place(const RayScene& ground, const Lens& lens,
                                            std::span<const View> views, Dice& dice) {
  const auto index = static_cast<std::size_t>(dice.between(0, static_cast<double>(views.size())));
  const View& view = views[std::min(index, views.size() - 1)];
  const double u = dice.between(0.25, 0.75) * lens.width,
               v = dice.between(0.25, 0.75) * lens.height;
  const SceneRay ray = to_world(view, *trace_pixel(lens, nullptr, u, v));
  const auto hit = ground.first_hit(ray.start, ray.direction);
  if (!hit) return std::nullopt;
  return ray.start + hit->distance * ray.direction;
}

// Points of the ground below a square with sides of `side` around `middle`, seen from above.
void add_ground(const RayScene& ground, const Eigen::Vector3d& middle, double side,
                std::vector<Eigen::Vector3d>& points) {
  constexpr int kSteps = 24;
  constexpr double kAbove = 0.5;  // [m]
  for (int i = 0; i <= kSteps; ++i)
    for (int k = 0; k <= kSteps; ++k) {
      const Eigen::Vector3d start =
          middle + Eigen::Vector3d((i / double{kSteps} - 0.5) * side,
                                   (k / double{kSteps} - 0.5) * side, kAbove);
      const auto hit = ground.first_hit(start, -Eigen::Vector3d::UnitZ());
      if (hit) points.push_back(start - hit->distance * Eigen::Vector3d::UnitZ());
    }
}

// z = height + slope . (x, y), relative to `origin`, with no point above it.
struct Plane {
  Eigen::Vector2d slope;
  double height = 0, roughness = 0;  // roughness: how far points are from a common plane [m]
};

Plane plane_above(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& origin) {
  Eigen::MatrixX3d a(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::VectorXd z(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const Eigen::Vector3d p = points[static_cast<std::size_t>(i)] - origin;
    a.row(i) << p.x(), p.y(), 1;
    z[i] = p.z();
  }
  const Eigen::Vector3d fit = a.colPivHouseholderQr().solve(z);
  const Eigen::VectorXd above = z - a * fit;
  return {fit.head<2>(), fit.z() + above.maxCoeff() + kSlab, above.maxCoeff() - above.minCoeff()};
}

// Axes whose third column points into the ground below a plane with this slope. The first column
// lies above `along`.
Eigen::Matrix3d axes_on(const Plane& plane, const Eigen::Vector2d& along) {
  const Eigen::Vector3d down = Eigen::Vector3d(plane.slope.x(), plane.slope.y(), -1).normalized();
  const Eigen::Vector3d right =
      Eigen::Vector3d(along.x(), along.y(), plane.slope.dot(along)).normalized();
  Eigen::Matrix3d axes;
  axes << right, down.cross(right), down;
  return axes;
}

bool touches(const std::vector<Plate>& plates, const Eigen::Vector3d& centre, double side) {
  return std::ranges::any_of(plates, [&](const Plate& plate) {
    return (plate.centre - centre).norm() < kLeastGap * side;
  });
}

// One plate (`bar` 0), or the two plates of a bar of this length [m], around a random place. Empty
// if the place does not serve.
std::vector<Plate> try_to_lay(const RayScene& ground, const Lens& lens, std::span<const View> views,
                              const PlateLayout& layout, double bar, Dice& dice) {
  const auto place = random_place(ground, lens, views, dice);
  const double angle = dice.between(0, kTurn), turn = dice.between(0, kTurn);
  if (!place) return {};
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  const Eigen::Vector3d step = bar / 2 * Eigen::Vector3d(along.x(), along.y(), 0);
  std::vector<Eigen::Vector3d> points;
  add_ground(ground, *place - step, 1.5 * layout.side, points);
  if (bar > 0) add_ground(ground, *place + step, 1.5 * layout.side, points);
  if (points.size() < 600) return {};
  const Plane plane = plane_above(points, *place);
  if (plane.slope.norm() > kMostSlope || plane.roughness > std::min(0.6 * layout.side, 0.2))
    return {};
  const Eigen::Matrix3d axes = axes_on(plane, along);
  const Eigen::Matrix3d turned = axes * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d middle = *place + Eigen::Vector3d(0, 0, plane.height);
  if (bar == 0) return {{middle, turned, layout.side}};
  return {{middle - bar / 2 * axes.col(0), turned, layout.side},
          {middle + bar / 2 * axes.col(0), turned, layout.side}};
}

// The pixel whose ray passes through `point`, by Newton's method on trace_pixel().
std::optional<Eigen::Vector2d> pixel_of_point(const Lens& lens, const Port* port, const View& view,
                                              const Eigen::Vector3d& point) {
  const Eigen::Vector3d in_camera = view.rotation * (point - view.centre);
  if (!(in_camera.z() > 0)) return std::nullopt;
  Eigen::Vector2d pixel = pixel_of(lens, in_camera);
  const auto miss = [&](const Eigen::Vector2d& p) -> std::optional<Eigen::Vector2d> {
    const auto ray = trace_pixel(lens, port, p.x(), p.y());
    if (!ray) return std::nullopt;
    const Eigen::Vector3d offset = in_camera - ray->start;
    return (offset / offset.z() - ray->direction / ray->direction.z()).head<2>();
  };
  for (int i = 0; i < 20; ++i) {
    const auto here = miss(pixel), x = miss(pixel + Eigen::Vector2d(0.01, 0)),
               y = miss(pixel + Eigen::Vector2d(0, 0.01));
    if (!here || !x || !y) return std::nullopt;
    Eigen::Matrix2d slope;
    slope << (*x - *here) / 0.01, (*y - *here) / 0.01;
    const Eigen::Vector2d step = slope.inverse() * *here;
    pixel -= step;
    if (!pixel.allFinite() || pixel.norm() > 1e6) return std::nullopt;
    if (step.norm() < 1e-9) return pixel;
  }
  return std::nullopt;
}

bool hides(const RayScene& scene, const Lens& lens, const Port* port, const View& view,
           const Eigen::Vector2d& pixel, const Eigen::Vector3d& point) {
  const SceneRay ray = to_world(view, *trace_pixel(lens, port, pixel.x(), pixel.y()));
  return scene.blocked(ray.start, ray.direction, 0, (point - ray.start).norm() - 0.001);
}

}  // namespace

std::vector<Plate> lay_plates(const RayScene& ground, const Lens& lens, std::span<const View> views,
                              const PlateLayout& layout) {
  constexpr int kTries = 2000;
  for (const double bar : layout.bars)
    if (bar < kLeastGap * layout.side)
      fail("a bar of {} m is too short for plates of {} m", bar, layout.side);
  std::vector<Plate> plates;
  Dice dice(layout.seed);
  for (std::size_t i = 0; i < layout.single + layout.bars.size(); ++i) {
    const double bar = i < layout.single ? 0 : layout.bars[i - layout.single];
    std::vector<Plate> more;
    for (int tried = 0; more.empty(); ++tried) {
      if (tried == kTries)
        fail("there is no level ground for plate {} of {} m", i + 1, layout.side);
      more = try_to_lay(ground, lens, views, layout, bar, dice);
      if (std::ranges::any_of(
              more, [&](const Plate& plate) { return touches(plates, plate.centre, layout.side); }))
        more.clear();
    }
    std::ranges::move(more, std::back_inserter(plates));
  }
  return plates;
}

TriangleMesh plate_mesh(std::span<const Plate> plates) {
  TriangleMesh mesh;
  for (const Plate& plate : plates) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto corners = corners_of(plate);
    for (const double depth : {0.0, kSlab})
      for (const Eigen::Vector3d& corner : corners)
        mesh.vertices.push_back((corner + depth * plate.axes.col(2)).cast<float>());
    // Seen from above, the corners are clockwise; outside is up.
    mesh.faces.push_back({first, first + 3, first + 2});
    mesh.faces.push_back({first, first + 2, first + 1});
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t a = first + k, b = first + (k + 1) % 4;
      mesh.faces.push_back({a, b, b + 4});
      mesh.faces.push_back({a, b + 4, a + 4});
    }
  }
  return mesh;
}

Shader with_plates(Shader ground, std::vector<Plate> plates, std::uint32_t first_face,
                   int samples) {
  constexpr int kSamples = 4;  // along each side of the footprint of a ray
  const auto shared = std::make_shared<const std::vector<Plate>>(std::move(plates));
  return [ground = std::move(ground), shared, first_face, samples](const SurfacePoint& point) {
    if (point.hit.face < first_face) return ground(point);
    const std::uint32_t face = point.hit.face - first_face;
    const Plate& plate = (*shared)[face / kPlateFaces];
    if (face % kPlateFaces >= 2) return Eigen::Vector3f(Eigen::Vector3f::Constant(kBlack));
    const Eigen::Vector3d place =
        plate.axes.transpose() * (point.position - plate.centre) * 2 / plate.side;
    const double step = point.footprint / samples * 2 / plate.side / kSamples;
    int white = 0;
    for (int i = 0; i < kSamples * kSamples; ++i)
      white += plate.white(place.x() + (i % kSamples - 1.5) * step,
                           place.y() + (i / kSamples - 1.5) * step);
    const float share = static_cast<float>(white) / (kSamples * kSamples);
    return Eigen::Vector3f(Eigen::Vector3f::Constant(kBlack + share * (kWhite - kBlack)));
  };
}

std::optional<std::vector<Eigen::Vector2d>> pixels_of(const Plate& plate,
                                                      std::span<const Eigen::Vector2d> places,
                                                      const Lens& lens, const Port* port,
                                                      const View& view) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector2d& place : places) {
    const auto pixel = pixel_of_point(lens, port, view, point_on(plate, place));
    if (!pixel) return std::nullopt;
    pixels.push_back(*pixel);
  }
  return pixels;
}

std::optional<PlateImage> image_of(const Plate& plate, const RayScene& scene, const Lens& lens,
                                   const Port* port, const View& view) {
  const std::vector<Eigen::Vector2d> places = places_on_plate();
  const auto seen = pixels_of(plate, places, lens, port, view);
  if (!seen) return std::nullopt;
  const std::vector<Eigen::Vector2d>& pixels = *seen;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (pixels[i].minCoeff() < 0 || pixels[i].x() > lens.width - 1 ||
        pixels[i].y() > lens.height - 1 ||
        hides(scene, lens, port, view, pixels[i], point_on(plate, places[i])))
      return std::nullopt;
  double twice = 0;
  for (std::size_t k = 1; k <= 4; ++k) {
    const Eigen::Vector2d &a = pixels[k], &b = pixels[k % 4 + 1];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  const SceneRay ray = to_world(view, *trace_pixel(lens, port, pixels[0].x(), pixels[0].y()));
  if (!(twice > 0)) return std::nullopt;  // seen from below
  return PlateImage{pixels[0], std::sqrt(twice / 2),
                    std::acos(std::clamp(ray.direction.dot(plate.axes.col(2)), -1.0, 1.0))};
}

}  // namespace axial::simulate
