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

  // The mean light around `pixel` over about `width` pixels.
  Eigen::Array3f read(const Eigen::Vector2d& pixel, double width) const {
    const double level =
        std::clamp(std::log2(std::max(width, 1.0)), 0.0, static_cast<double>(levels_.size() - 1));
    const auto below = static_cast<std::size_t>(level);
    const auto part = static_cast<float>(level - static_cast<double>(below));
    const Eigen::Array3f fine = at(below, pixel);
    return part > 0 ? Eigen::Array3f(fine + part * (at(below + 1, pixel) - fine)) : fine;
  }

 private:
  Eigen::Array3f at(std::size_t level, const Eigen::Vector2d& pixel) const {
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
    return (1 - b) * ((1 - a) * corner(0, 0) + a * corner(1, 0)) +
           b * ((1 - a) * corner(0, 1) + a * corner(1, 1));
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

// Places of a square patch, in units of its half side: rows and columns at equal steps.
constexpr int kSide = 4;  // places of a side
constexpr std::size_t kPlaces = kSide * kSide;
constexpr double place_in_patch(int i) {
  return (2.0 * i + 1) / kSide - 1;
}

// The mean light of a patch. Its spread: the largest difference between its four quarters.
void set_light(std::span<const Eigen::Array3f, kPlaces> lights, Observation& seen) {
  std::array<Eigen::Array3f, 4> quarters;
  quarters.fill(Eigen::Array3f::Zero());
  for (std::size_t i = 0; i < kPlaces; ++i)
    quarters[2 * (i / (2 * kSide)) + i % kSide / (kSide / 2)] += 4 * lights[i] / kPlaces;
  const auto& [a, b, c, d] = quarters;
  seen.light = 0.25f * (a + b + c + d);
  seen.spread = a.max(b).max(c.max(d)) - a.min(b).min(c.min(d));
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

Observations every(std::size_t step, std::size_t first, const Observations& observations) {
  Observations part;
  part.first.push_back(0);
  for (std::size_t point = first; point < observations.points(); point += step) {
    for (Observation seen : observations.of(point)) {
      seen.point = static_cast<std::uint32_t>(part.points());
      part.all.push_back(seen);
    }
    part.first.push_back(part.all.size());
  }
  return part;
}

Observations without_shadows(const Observations& observations) {
  Observations open;
  open.first.push_back(0);
  for (std::size_t point = 0; point < observations.points(); ++point) {
    for (const Observation& seen : observations.of(point))
      if (seen.open) open.all.push_back(seen);
    open.first.push_back(open.all.size());
  }
  return open;
}

std::uint64_t SeenSurface::bytes_to_observe(const ObserveOptions& options) {
  constexpr std::uint64_t kSeenBy = 20;  // photographs that show a point
  // A point while those on uneven places are left out; its observations by view, by point, and
  // sorted.
  return options.points * (2 * sizeof(Point) + kSeenBy * 3 * sizeof(Observation));
}

std::uint64_t bytes_to_see(const Mesh& mesh) {
  return geometry::bytes_of_surface(mesh) + mesh.vertices.size() * sizeof(Eigen::Vector3f);
}

SeenSurface::SeenSurface(const Mesh& mesh, const Eigen::Vector3d& up)
    : mesh_(mesh), up_(up), surface_(mesh), normals_(geometry::vertex_normals(mesh)) {}

std::optional<SeenSurface::Point> SeenSurface::on_ray(const Eigen::Vector3d& start,
                                                      const Eigen::Vector3d& direction) const {
  const auto hit = surface_.first_hit(start, direction);
  if (!hit || (!mesh_.unseen.empty() && mesh_.unseen[hit->face] != 0)) return std::nullopt;
  const auto& corners = mesh_.faces[hit->face];
  const auto between = [&](const std::vector<Eigen::Vector3f>& of) -> Eigen::Vector3f {
    return (1 - hit->u - hit->v) * of[corners[0]] + hit->u * of[corners[1]] +
           hit->v * of[corners[2]];
  };
  return Point{between(mesh_.vertices).cast<double>(), surface_.face_normal(hit->face),
               between(normals_).normalized()};
}

Sight SeenSurface::sight_of(const Point& point, const Eigen::Vector3d& from,
                            const Eigen::Vector2d& pixel,
                            const geometry::PosedCamera& posed) const {
  const Eigen::Vector3d way = point.place - from;
  const double length = way.norm();
  return {place_of(pixel, posed.camera), static_cast<float>(length),
          (posed.pose.rotation * point.normal.cast<double>()).cast<float>(),
          (way / length).cast<float>(), static_cast<float>(up_.dot(point.place))};
}

bool SeenSurface::set_patch(double half_side, Point& point) const {
  constexpr double kUneven = 0.25;  // of half the side
  const Eigen::Vector3d normal = point.normal.cast<double>();
  const Eigen::Vector3d across = normal.unitOrthogonal(), along = normal.cross(across);
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const Eigen::Vector3d above = point.place + half_side * (normal + place_in_patch(i) * across +
                                                               place_in_patch(j) * along);
      const auto on = on_ray(above, -normal);
      if (!on || std::abs((on->place - above).norm() - half_side) > kUneven * half_side)
        return false;
      point.patch[static_cast<std::size_t>(j * kSide + i)] = on->place;
    }
  return true;
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

// Whether a face is between a place and the middle or a corner of the point's patch.
bool SeenSurface::is_hidden(const Point& point, const Eigen::Vector3d& from) const {
  const auto hidden = [&](const Eigen::Vector3d& place) {
    return surface_.between(from, place, 0, kTolerance);
  };
  const auto& patch = point.patch;
  return hidden(point.place) || hidden(patch[0]) || hidden(patch[kSide - 1]) ||
         hidden(patch[kPlaces - kSide]) || hidden(patch[kPlaces - 1]);
}

bool SeenSurface::is_open(const Point& point, const Eigen::Vector3d& from, const Pose& pose) const {
  constexpr double kAway = 0.4;  // [m]
  for (const double side : {-kAway, kAway})
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector3d lamp = from + side * pose.rotation.row(axis).transpose();
      const bool can_be_there = !surface_.between(from, lamp, 0, 0);
      if (can_be_there && surface_.between(lamp, point.place, 0, kTolerance)) return false;
    }
  return true;
}

// What a camera sees of the points, in their order.
template <class Camera>
std::vector<Observation> SeenSurface::observed(
    const Camera& camera, const geometry::PosedCamera& posed, std::span<const Point> points,
    const LightPyramid& light, const ObserveOptions& options, double half_side) const {
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
        if (is_hidden(point, from)) return;
        Observation& seen = found[i];
        seen.point = static_cast<std::uint32_t>(i);
        seen.sight = sight_of(point, from, image.pixel, posed);
        const Eigen::Vector3d normal = posed.pose.rotation * point.face_normal;
        const double step = 2 * half_side / kSide * scale_on_surface(slopes, normal);
        std::array<Eigen::Array3f, kPlaces> lights;
        for (std::size_t k = 0; k < kPlaces; ++k) {
          const Eigen::Vector3d away = point.patch[k] - point.place;
          const Eigen::Vector2d pixel = image.pixel + slopes * (posed.pose.rotation * away);
          if (!geometry::is_in_image(posed.camera, pixel, 0)) return;
          lights[k] = light.read(pixel, step);
        }
        set_light(lights, seen);
        seen.open = is_open(point, from, posed.pose);
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
  const double half_side = 0.5 * options.window * usual_way / first.lens.fx;
  std::vector<char> even(points.size());
  parallel_for(
      points.size(), [&](std::size_t i) { even[i] = set_patch(half_side, points[i]); },
      kPointGrain);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (even[i]) points[kept++] = points[i];
  points.resize(kept);
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
          return observed(camera, posed, points, pyramid, options, half_side);
        },
        make_camera<double>(posed.camera)));
    for (Observation& seen : views.back()) seen.view = static_cast<std::uint32_t>(view);
    progress.add();
  }
  return by_point(views, points.size());
}

SightImage SeenSurface::sights(const geometry::PosedCamera& posed) const {
  SightImage image(posed.camera.width, posed.camera.height);
  std::visit(
      [&](const auto& camera) {
        parallel_for(static_cast<std::size_t>(image.height), [&](std::size_t row) {
          const int y = static_cast<int>(row);
          for (int x = 0; x < image.width; ++x) {
            const Eigen::Vector2d pixel(x, y);
            const Eigen::Vector3d start = posed.pose.to_world(camera.exit_point(pixel));
            const Eigen::Vector3d to_surface =
                posed.pose.rotation.transpose() * camera.ray(pixel).direction;
            const auto point = on_ray(start, to_surface);
            if (point)
              image.at(x, y) = sight_of(*point, start, pixel, posed);
            else
              image.at(x, y) = {
                  place_of(pixel, posed.camera), 0, {0, 0, -1}, to_surface.cast<float>()};
          }
        });
      },
      make_camera<double>(posed.camera));
  return image;
}

}  // namespace axial::color
