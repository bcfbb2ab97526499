// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/face_sights.h"

#include <Eigen/Geometry>
#include <limits>

#include "base/parallel.h"
#include "scene/any_camera.h"

namespace axial::geometry {
namespace {

// A place on a face that cameras look at. The normal has the length 1, or 0 for a face without
// area.
struct Middle {
  Eigen::Vector3d point, normal;
};

Middle middle_of(const Mesh& mesh, std::size_t face) {
  Eigen::Matrix3d at;
  for (int k = 0; k < 3; ++k)
    at.col(k) = mesh.vertices[mesh.faces[face][static_cast<std::size_t>(k)]].cast<double>();
  return {at.rowwise().mean(), (at.col(1) - at.col(0)).cross(at.col(2) - at.col(0)).normalized()};
}

void count(std::uint16_t& number) {
  if (number < std::numeric_limits<std::uint16_t>::max()) ++number;
}

// The faces to look at, of which there are `count`: `some`, or the first ones without `some`.
struct Faces {
  const Mesh& mesh;
  std::size_t count;
  std::span<const std::uint32_t> some = {};

  std::size_t operator[](std::size_t i) const { return some.empty() ? i : some[i]; }
};

// Counts one camera at the faces that it sees.
template <class Camera>
void look(const Faces& faces, const Occluders& occluders, const Camera& camera,
          const PosedCamera& posed, const SightOptions& options, FaceSights& sights) {
  parallel_for(
      faces.count,
      [&](std::size_t i) {
        const Middle middle = middle_of(faces.mesh, faces[i]);
        Eigen::Vector3d origin;  // the path of light is straight from here to the point
        const auto image = camera.project(posed.pose.to_camera(middle.point), nullptr, &origin);
        if (!image.visible || image.pixel.minCoeff() < -0.5 ||
            image.pixel.x() > posed.camera.width - 0.5 ||
            image.pixel.y() > posed.camera.height - 0.5)
          return;
        const Eigen::Vector3d from = posed.pose.to_world(origin);
        const double cosine = (from - middle.point).normalized().dot(middle.normal);
        if (cosine == 0 || std::abs(cosine) < options.least_cosine) return;
        if (occluders.between(from, middle.point, options.tolerance)) return;
        count(cosine > 0 ? sights.front[i] : sights.back[i]);
      },
      kPointGrain);
}

FaceSights sights_of(const Faces& faces, const Occluders& occluders,
                     std::span<const PosedCamera> cameras, const SightOptions& options,
                     const ProgressSink& progress) {
  FaceSights sights{std::vector<std::uint16_t>(faces.count),
                    std::vector<std::uint16_t>(faces.count)};
  ProgressCounter counter(progress, cameras.size());
  for (const PosedCamera& posed : cameras) {
    std::visit([&](const auto& camera) { look(faces, occluders, camera, posed, options, sights); },
               make_camera<double>(posed.camera));
    counter.add();
  }
  return sights;
}

}  // namespace

FaceSights count_sights(const Mesh& mesh, std::span<const PosedCamera> cameras,
                        const SightOptions& options, const ProgressSink& progress) {
  const Occluders occluders(mesh);
  return sights_of({mesh, mesh.faces.size()}, occluders, cameras, options, progress);
}

FaceSights count_sights(const Mesh& mesh, const Occluders& occluders,
                        std::span<const std::uint32_t> faces, std::span<const PosedCamera> cameras,
                        const SightOptions& options) {
  return sights_of({mesh, faces.size(), faces}, occluders, cameras, options, {});
}

std::uint64_t bytes_of_sights(const Mesh& mesh) {
  constexpr std::uint64_t kTreePerFace = 160;  // Embree's tree while it is built
  return mesh.vertices.size() * sizeof(Eigen::Vector3f) +
         mesh.faces.size() * (kTreePerFace + 2 * sizeof(std::uint16_t));
}

}  // namespace axial::geometry
