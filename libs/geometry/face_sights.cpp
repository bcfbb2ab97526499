// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/face_sights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "base/parallel.h"
#include "geometry/vertex_normals.h"
#include "scene/any_camera.h"

namespace axial::geometry {
namespace {

// The corners of a face, and its normal, of the length 1, or 0 for a face without area.
struct Triangle {
  Eigen::Matrix3d at;  // columns: corners
  Eigen::Vector3d normal;

  Triangle(const Mesh& mesh, std::size_t face) {
    for (int k = 0; k < 3; ++k)
      at.col(k) = mesh.vertices[mesh.faces[face][static_cast<std::size_t>(k)]].cast<double>();
    normal = (at.col(1) - at.col(0)).cross(at.col(2) - at.col(0)).normalized();
  }
  Eigen::Vector3d middle() const { return at.rowwise().mean(); }
};

void count(std::uint16_t& number) {
  if (number < std::numeric_limits<std::uint16_t>::max()) ++number;
}

// A cone that contains all points that a camera sees. It saves the exact projection of most of the
// others.
template <class Camera>
class ViewCone {
 public:
  ViewCone(const Camera& camera, const PosedCamera& posed) {
    constexpr int kSteps = 16;  // along each side of the image
    const double width = posed.camera.width, height = posed.camera.height;
    double widest = 0, offset = 0;
    for (int i = 0; i <= kSteps; ++i) {
      const double s = static_cast<double>(i) / kSteps;
      for (const Eigen::Vector2d& pixel :
           {Eigen::Vector2d(s * width, 0), Eigen::Vector2d(s * width, height),
            Eigen::Vector2d(0, s * height), Eigen::Vector2d(width, s * height)}) {
        const auto ray = camera.ray(pixel - Eigen::Vector2d::Constant(0.5));
        widest = std::max(widest, std::acos(std::clamp(ray.direction.z(), -1.0, 1.0)));
        offset = std::max(offset, ray.origin.norm());
      }
    }
    constexpr double kMargin = 0.05, kLargest = 1.4;  // [rad]
    widest += kMargin;
    if (!(widest < kLargest) || !std::isfinite(offset)) return;
    cosine_ = std::cos(widest);
    axis_ = posed.pose.rotation.row(2).transpose();
    // A cone with this apex contains the cones from all origins of rays.
    apex_ = posed.pose.centre - 1.1 * offset / std::sin(widest) * axis_;
  }

  bool may_contain(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d way = point - apex_;
    return cosine_ < 0 || way.dot(axis_) >= cosine_ * way.norm();
  }

 private:
  double cosine_ = -1;  // of the angle between axis and side; below 0: the cone contains everything
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitZ(), apex_ = Eigen::Vector3d::Zero();
};

// One camera that looks at points of a mesh.
template <class Camera>
class Observer {
 public:
  Observer(const Surface& surface, const Camera& camera, const PosedCamera& posed,
           const SightOptions& options)
      : surface_(surface), camera_(camera), posed_(posed), options_(options) {}

  // The cosine of the angle between `normal` and the path of light from `point`; 0 if the camera
  // does not see the point. `tested_side`: 1 or -1, the sign of the cosines that are of interest;
  // 0: both.
  double cosine_at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                   int tested_side = 0) const {
    Eigen::Vector3d origin;  // the path of light is straight from here to the point
    const auto image = camera_.project(posed_.pose.to_camera(point), nullptr, &origin);
    if (!image.visible || !is_in_image(posed_.camera, image.pixel, -0.5)) return 0;
    const Eigen::Vector3d from = posed_.pose.to_world(origin);
    const double cosine = (from - point).normalized().dot(normal);
    if (cosine == 0 || std::abs(cosine) < options_.least_cosine || cosine * tested_side < 0)
      return 0;
    return surface_.between(from, point, 0, options_.tolerance) ? 0 : cosine;
  }

 private:
  const Surface& surface_;
  const Camera& camera_;
  const PosedCamera& posed_;
  const SightOptions& options_;
};

// Calls look(camera, observer) with each camera, in their order.
template <class Look>
void for_each_observer(const Surface& surface, std::span<const PosedCamera> cameras,
                       const SightOptions& options, const ProgressSink& progress,
                       const Look& look) {
  ProgressCounter counter(progress, cameras.size());
  for (const PosedCamera& posed : cameras) {
    std::visit(
        [&](const auto& camera) {
          look(ViewCone(camera, posed), Observer(surface, camera, posed, options));
        },
        make_camera<double>(posed.camera));
    counter.add();
  }
}

// The faces to look at, of which there are `count`: `some`, or the first ones without `some`.
struct Faces {
  const Mesh& mesh;
  std::size_t count;
  std::span<const std::uint32_t> some = {};

  std::size_t operator[](std::size_t i) const { return some.empty() ? i : some[i]; }
};

FaceSights sights_of(const Faces& faces, const Surface& surface,
                     std::span<const PosedCamera> cameras, const SightOptions& options,
                     const ProgressSink& progress) {
  FaceSights sights{std::vector<std::uint16_t>(faces.count),
                    std::vector<std::uint16_t>(faces.count)};
  for_each_observer(surface, cameras, options, progress,
                    [&](const auto& cone, const auto& observer) {
                      parallel_for(
                          faces.count,
                          [&](std::size_t i) {
                            const Triangle triangle(faces.mesh, faces[i]);
                            const Eigen::Vector3d middle = triangle.middle();
                            if (!cone.may_contain(middle)) return;
                            const double cosine = observer.cosine_at(middle, triangle.normal);
                            if (cosine != 0) count(cosine > 0 ? sights.front[i] : sights.back[i]);
                          },
                          kPointGrain);
                    });
  return sights;
}

}  // namespace

FaceSights count_sights(const Mesh& mesh, std::span<const PosedCamera> cameras,
                        const SightOptions& options, const ProgressSink& progress) {
  return sights_of({mesh, mesh.faces.size()}, Surface(mesh), cameras, options, progress);
}

FaceSights count_sights(const Mesh& mesh, const Surface& surface,
                        std::span<const std::uint32_t> faces, std::span<const PosedCamera> cameras,
                        const SightOptions& options) {
  return sights_of({mesh, faces.size(), faces}, surface, cameras, options, {});
}

std::vector<float> second_cosines(const Mesh& mesh, std::span<const PosedCamera> cameras,
                                  float enough, const SightOptions& options,
                                  const ProgressSink& progress) {
  const std::vector<Eigen::Vector3f> normals = vertex_normals(mesh);
  std::vector<std::array<float, 2>> best(mesh.faces.size(), {-1, -1});  // the larger one first
  for_each_observer(
      Surface(mesh), cameras, {.tolerance = options.tolerance}, progress,
      [&](const auto& cone, const auto& observer) {
        parallel_for(
            mesh.faces.size(),
            [&](std::size_t face) {
              auto& [first, second] = best[face];
              if (second >= enough) return;
              const Eigen::Vector3d middle = Triangle(mesh, face).middle();
              if (!cone.may_contain(middle)) return;
              const auto& [a, b, c] = mesh.faces[face];
              const Eigen::Vector3f smooth = (normals[a] + normals[b] + normals[c]).normalized();
              const auto cosine =
                  static_cast<float>(observer.cosine_at(middle, smooth.cast<double>(), 1));
              if (!(cosine > 0)) return;
              second = std::max(second, std::min(first, cosine));
              first = std::max(first, cosine);
            },
            kPointGrain);
      });
  std::vector<float> seconds;
  seconds.reserve(best.size());
  for (const auto& [first, second] : best) seconds.push_back(second);
  return seconds;
}

std::uint64_t bytes_of_sights(const Mesh& mesh) {
  return bytes_of_surface(mesh) + mesh.faces.size() * 2 * sizeof(std::uint16_t);
}

std::uint64_t bytes_of_cosines(const Mesh& mesh) {
  return bytes_of_sights(mesh) + mesh.vertices.size() * sizeof(Eigen::Vector3f) +
         mesh.faces.size() * 3 * sizeof(float);
}

}  // namespace axial::geometry
