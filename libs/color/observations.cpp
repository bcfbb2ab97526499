// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/observations.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/context.h"
#include "base/order_statistics.h"
#include "base/parallel.h"
#include "geometry/posed_camera.h"
#include "geometry/vertex_normals.h"
#include "scene/camera_model.h"

namespace axial::color {
namespace {

constexpr double kBorder = 2;        // [px]
constexpr double kTolerance = 1e-3;  // of the way, in which a face does not hide a point

geometry::PosedCamera reduced(const geometry::PosedCamera& posed, int longest_side) {
  const int longest = std::max(posed.camera.width, posed.camera.height);
  if (longest <= longest_side) return posed;
  const auto side = [&](int length) {
    return std::max(
        1, static_cast<int>(std::lround(static_cast<double>(length) * longest_side / longest)));
  };
  return {posed.camera.resized(side(posed.camera.width), side(posed.camera.height)), posed.pose};
}

}  // namespace

// A photograph's light, averaged over squares of 1, 2, 4 ... pixels.
class LightPyramid {
 public:
  explicit LightPyramid(cv::Mat3f light) : levels_{std::move(light)} {
    constexpr int kLevels = 6, kLeastSide = 8;
    while (levels_.size() < kLevels &&
           std::min(levels_.back().cols, levels_.back().rows) >= 2 * kLeastSide) {
      cv::Mat3f half;
      cv::resize(levels_.back(), half, {levels_.back().cols / 2, levels_.back().rows / 2}, 0, 0,
                 cv::INTER_AREA);
      levels_.push_back(half);
    }
  }

  // Reads the mean light around `pixel` over about `width` pixels, and how much it differs nearby.
  void read(const Eigen::Vector2d& pixel, double width, Observation& into) const {
    const double level =
        std::clamp(std::log2(std::max(width, 1.0)), 0.0, static_cast<double>(levels_.size() - 1));
    const auto below = static_cast<std::size_t>(level);
    const auto part = static_cast<float>(level - static_cast<double>(below));
    const Sample fine = at(below, pixel);
    into.light = fine.light;
    into.spread = fine.spread;
    if (!(part > 0)) return;
    const Sample coarse = at(below + 1, pixel);
    into.light += part * (coarse.light - fine.light);
    into.spread += part * (coarse.spread - fine.spread);
  }

 private:
  struct Sample {
    Eigen::Array3f light, spread;
  };

  Sample at(std::size_t level, const Eigen::Vector2d& pixel) const {
    const cv::Mat3f& image = levels_[level];
    // Sides of odd lengths are not halved exactly.
    const double across = static_cast<double>(image.cols) / levels_[0].cols;
    const double down = static_cast<double>(image.rows) / levels_[0].rows;
    const double px = std::clamp((pixel.x() + 0.5) * across - 0.5, 0.0, image.cols - 1.001);
    const double py = std::clamp((pixel.y() + 0.5) * down - 0.5, 0.0, image.rows - 1.001);
    const int x = static_cast<int>(px), y = static_cast<int>(py);
    const auto a = static_cast<float>(px - x), b = static_cast<float>(py - y);
    const auto corner = [&](int i, int j) {
      const cv::Vec3f& v = image(y + j, x + i);
      return Eigen::Array3f(v[0], v[1], v[2]);
    };
    const Eigen::Array3f c00 = corner(0, 0), c10 = corner(1, 0), c01 = corner(0, 1),
                         c11 = corner(1, 1);
    return {(1 - b) * ((1 - a) * c00 + a * c10) + b * ((1 - a) * c01 + a * c11),
            c00.max(c10).max(c01.max(c11)) - c00.min(c10).min(c01.min(c11))};
  }

  std::vector<cv::Mat3f> levels_;
};

namespace {

// How long a surface with the unit normal `normal` (camera frame) is in the image, in the geometric
// mean over directions [px/m]. `slopes`: d(pixel)/dX.
double scale_on_surface(const Eigen::Matrix<double, 2, 3>& slopes, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d across = normal.unitOrthogonal(), along = normal.cross(across);
  Eigen::Matrix2d in_surface;
  in_surface << slopes * across, slopes * along;
  return std::sqrt(std::abs(in_surface.determinant()));
}

// Sorts by point, and leaves out points that only one photograph shows.
Observations by_point(const std::vector<std::vector<Observation>>& views, std::size_t points) {
  std::vector<std::vector<Observation>> of_point(points);
  for (const auto& view : views)
    for (const Observation& seen : view) of_point[seen.point].push_back(seen);
  Observations sorted;
  sorted.first.push_back(0);
  for (auto& list : of_point) {
    if (list.size() < 2) continue;
    for (Observation& seen : list) {
      seen.point = static_cast<std::uint32_t>(sorted.points());
      sorted.all.push_back(seen);
    }
    sorted.first.push_back(sorted.all.size());
  }
  return sorted;
}

}  // namespace

Eigen::Vector2f place_of(const Eigen::Vector2d& pixel, const CameraModel& camera) {
  const Eigen::Vector2d middle(0.5 * (camera.width - 1), 0.5 * (camera.height - 1));
  return ((pixel - middle) / (0.5 * std::max(camera.width, camera.height))).cast<float>();
}

std::uint64_t bytes_to_see(const Mesh& mesh) {
  return geometry::bytes_of_surface(mesh) + mesh.vertices.size() * sizeof(Eigen::Vector3f);
}

SeenSurface::SeenSurface(const Mesh& mesh)
    : mesh_(mesh), surface_(mesh), normals_(geometry::vertex_normals(mesh)) {}

std::optional<SeenSurface::Point> SeenSurface::on_ray(const Eigen::Vector3d& start,
                                                      const Eigen::Vector3d& direction) const {
  const auto hit = surface_.first_hit(start, direction);
  if (!hit || (!mesh_.unseen.empty() && mesh_.unseen[hit->face] != 0)) return std::nullopt;
  const auto& [a, b, c] = mesh_.faces[hit->face];
  const auto between = [&](const std::vector<Eigen::Vector3f>& of) -> Eigen::Vector3f {
    return (1 - hit->u - hit->v) * of[a] + hit->u * of[b] + hit->v * of[c];
  };
  return Point{between(mesh_.vertices).cast<double>(), surface_.face_normal(hit->face),
               between(normals_).normalized()};
}

// The points on the rays of a grid of about `count` pixels. Adds their ways to `ways`.
std::vector<SeenSurface::Point> SeenSurface::points_in(const geometry::PosedCamera& posed,
                                                       std::size_t count,
                                                       std::vector<double>& ways) const {
  const double width = posed.camera.width, height = posed.camera.height;
  const double step = std::max(1.0, std::sqrt(width * height / static_cast<double>(count)));
  std::vector<Point> points;
  std::visit(
      [&](const auto& camera) {
        for (double y = 0.5 * step; y < height; y += step)
          for (double x = 0.5 * step; x < width; x += step) {
            const Eigen::Vector2d pixel(x, y);
            const Eigen::Vector3d start = posed.pose.to_world(camera.exit_point(pixel));
            const auto point =
                on_ray(start, posed.pose.rotation.transpose() * camera.ray(pixel).direction);
            if (!point) continue;
            points.push_back(*point);
            ways.push_back((point->place - start).norm());
          }
      },
      make_camera<double>(posed.camera));
  return points;
}

// What a camera sees of the points, in their order.
template <class Camera>
std::vector<Observation> SeenSurface::observed(const Camera& camera,
                                               const geometry::PosedCamera& posed,
                                               std::span<const Point> points,
                                               const LightPyramid& light,
                                               const ObserveOptions& options, double width) const {
  std::vector<Observation> found(points.size());
  std::vector<char> is_seen(points.size(), 0);
  parallel_for(
      points.size(),
      [&](std::size_t i) {
        const Point& point = points[i];
        refractive::Matrix23<double> slopes;
        const auto image = camera.project(posed.pose.to_camera(point.place), &slopes);
        if (!image.visible || !geometry::is_in_image(posed.camera, image.pixel, kBorder)) return;
        const Eigen::Vector3d from = posed.pose.to_world(camera.exit_point(image.pixel));
        const Eigen::Vector3d way = from - point.place;
        const double length = way.norm();
        if (way.dot(point.face_normal) < options.least_cosine * length) return;
        if (surface_.between(from, point.place, 0, kTolerance)) return;
        Observation& seen = found[i];
        seen.point = static_cast<std::uint32_t>(i);
        seen.sight = {place_of(image.pixel, posed.camera), static_cast<float>(length),
                      (posed.pose.rotation * point.normal.cast<double>()).cast<float>()};
        const Eigen::Vector3d normal = posed.pose.rotation * point.face_normal;
        light.read(image.pixel, width * scale_on_surface(slopes, normal), seen);
        is_seen[i] = 1;
      },
      kPointGrain);
  std::vector<Observation> seen;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (is_seen[i]) seen.push_back(found[i]);
  return seen;
}

Observations SeenSurface::observe(std::span<const geometry::PosedCamera> cameras,
                                  const LightSource& lights, const ObserveOptions& options,
                                  const Context& context) const {
  if (cameras.empty()) return {};
  std::vector<Point> points;
  std::vector<double> ways;
  for (const geometry::PosedCamera& posed : cameras) {
    const std::vector<Point> more =
        points_in(posed, std::max<std::size_t>(1, options.points / cameras.size()), ways);
    points.insert(points.end(), more.begin(), more.end());
  }
  const double usual_way = upper_median(std::move(ways));
  const CameraModel first = reduced(cameras.front(), options.longest_side).camera;
  const double width = options.window * usual_way / first.lens.fx;
  ProgressCounter progress(context.stage("Looking at photographs"), cameras.size());
  std::vector<std::vector<Observation>> views;
  for (std::size_t view = 0; view < cameras.size(); ++view) {
    const geometry::PosedCamera posed = reduced(cameras[view], options.longest_side);
    cv::Mat3f light = lights(view);
    if (light.cols != posed.camera.width || light.rows != posed.camera.height)
      cv::resize(light, light, {posed.camera.width, posed.camera.height}, 0, 0, cv::INTER_AREA);
    const LightPyramid pyramid(std::move(light));
    views.push_back(std::visit(
        [&](const auto& camera) {
          return observed(camera, posed, points, pyramid, options, width);
        },
        make_camera<double>(posed.camera)));
    for (Observation& seen : views.back()) seen.view = static_cast<std::uint32_t>(view);
    progress.add();
  }
  return by_point(views, points.size());
}

SightImage SeenSurface::sights(const geometry::PosedCamera& posed) const {
  const int width = posed.camera.width, height = posed.camera.height;
  SightImage image{cv::Mat1f(height, width, 0.0f), cv::Mat3f(height, width, cv::Vec3f(0, 0, 0))};
  const Eigen::Matrix3f to_camera = posed.pose.rotation.cast<float>();
  std::visit(
      [&](const auto& camera) {
        parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
          const int y = static_cast<int>(row);
          for (int x = 0; x < width; ++x) {
            const Eigen::Vector2d pixel(x, y);
            const Eigen::Vector3d start = posed.pose.to_world(camera.exit_point(pixel));
            const auto point =
                on_ray(start, posed.pose.rotation.transpose() * camera.ray(pixel).direction);
            if (!point) continue;
            image.way(y, x) = static_cast<float>((point->place - start).norm());
            const Eigen::Vector3f normal = to_camera * point->normal;
            image.normal(y, x) = {normal.x(), normal.y(), normal.z()};
          }
        });
      },
      make_camera<double>(posed.camera));
  return image;
}

}  // namespace axial::color
