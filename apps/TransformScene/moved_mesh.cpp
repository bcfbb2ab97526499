// SPDX-License-Identifier: GPL-3.0-or-later
#include "moved_mesh.h"

#include <cmath>

#include "base/error.h"
#include "base/program/output_name.h"
#include "evaluate/alignment.h"
#include "geometry/sampling.h"
#include "io/openmvs/point_source.h"
#include "io/ply/ply.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSeed = 1;
constexpr double kMostSamples = 1e8;

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const auto& face : mesh.faces) {
    const Eigen::Vector3d a = mesh.vertices[face[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[face[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[face[2]].cast<double>();
    area += (b - a).cross(c - a).norm() / 2;
  }
  return area;
}

std::size_t count_of_samples(const Options& options, const Mesh& mesh) {
  const double wanted = options.sample_mesh;
  const double count = std::ceil(wanted < 0 ? -wanted : wanted * area_of(mesh));
  if (!(count >= 1 && count <= kMostSamples))
    fail("--sample-mesh {}: gives {:.0f} points on {}, must be from 1 to {:.0f}", wanted, count,
         options.mesh.string(), kMostSamples);
  return static_cast<std::size_t>(count);
}

}  // namespace

Mesh moved_mesh(const Options& options, const FrameMove& move, const Context& context) {
  Mesh mesh = io::read_mesh_of_scene(move.from, options.mesh, context);
  if (mesh.faces.empty()) fail_in(options.mesh, "the mesh has no faces");
  evaluate::apply(move.similarity, mesh);
  return mesh;
}

fs::path samples_file(const Options& options) {
  return without_known_extension(options.output) += "_samples.ply";
}

void write_samples(const Options& options, const FrameMove& move, const fs::path& file,
                   const Context& context) {
  const Mesh mesh = moved_mesh(options, move, context);
  PointCloud cloud;
  cloud.positions = geometry::sample_surface(mesh, count_of_samples(options, mesh), kSeed);
  io::write_cloud_ply(file, cloud, false, {move.to});
}

}  // namespace axial::apps
