// SPDX-License-Identifier: GPL-3.0-or-later
// A room: a box on a floor, both with painted patterns, photographed by the simulator through a
// flat port or a dome. The simulator traces light from the pixels with Snell's law and shares no
// code with the cameras under test.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "axial/scene_images.h"
#include "axial/texture.h"
#include "scene/bilinear.h"
#include "simulate/render.h"

namespace axial::test {

inline constexpr float kBoxHeight = 0.2f;

// A floor of 1.6 m x 1.6 m at z = 0, and a box of 0.4 m x 0.3 m on it, without its underside.
inline Mesh room_mesh() {
  Mesh mesh;
  const auto quad = [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                        const Eigen::Vector3f& c, const Eigen::Vector3f& d) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
    mesh.faces.push_back({first, first + 1, first + 2});
    mesh.faces.push_back({first, first + 2, first + 3});
  };
  quad({-0.8f, -0.8f, 0}, {0.8f, -0.8f, 0}, {0.8f, 0.8f, 0}, {-0.8f, 0.8f, 0});
  const float x = 0.2f, y = 0.15f, z = kBoxHeight;
  quad({-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z});
  quad({-x, -y, 0}, {x, -y, 0}, {x, -y, z}, {-x, -y, z});
  quad({x, y, 0}, {-x, y, 0}, {-x, y, z}, {x, y, z});
  quad({x, -y, 0}, {x, y, 0}, {x, y, z}, {x, -y, z});
  quad({-x, y, 0}, {-x, -y, 0}, {-x, -y, z}, {-x, y, z});
  return mesh;
}

// Returns the mesh with each face split into 4^levels faces.
inline Mesh refined(Mesh mesh, int levels) {
  for (int k = 0; k < levels; ++k) {
    Mesh finer;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    finer.vertices = mesh.vertices;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), finer.vertices.size());
      if (is_new) finer.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
      return at->second;
    };
    for (const auto& [a, b, c] : mesh.faces) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.faces.insert(finer.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh = std::move(finer);
  }
  return mesh;
}

// Returns the colour R G B in [0, 1] of a point of the room. The pattern consists of waves of 10 cm
// or longer. The red of the box is higher than the red of the floor by 0.3.
inline Eigen::Vector3f pattern(const Eigen::Vector3d& p) {
  const double s = 2 * std::numbers::pi / 0.1;
  const double red = p.z() > 1e-3 ? 0.3 : 0;
  return Eigen::Vector3d(0.4 + red + 0.12 * std::sin(s * (p.x() + 0.5 * p.z())),
                         0.5 + 0.2 * std::sin(s * (p.y() - 0.4 * p.z())),
                         0.5 + 0.2 * std::sin(0.7 * s * (p.x() + p.y() + p.z())))
      .cast<float>();
}

struct Room {
  std::vector<texture::View> views;
  std::vector<texture::ViewImage> images;

  texture::ImageSource source() const {
    return [this](std::size_t v) { return images[v]; };
  }
};

inline simulate::Port room_port() {
  simulate::Port port;
  port.normal = simulate::tilted_normal(3);
  port.distance = 0.03, port.thickness = 0.012;
  port.n_glass = 1.5, port.n_water = 1.333;
  return port;
}

// A dome whose centre is 1 cm from the camera.
inline simulate::Port room_dome() {
  simulate::Port port = room_port();
  port.dome = simulate::Dome{{0.006, -0.004, 0.007}, 0.05};
  return port;
}

inline CameraModel camera_of(const simulate::Lens& lens, const simulate::Port& port) {
  CameraModel camera;
  camera.width = lens.width, camera.height = lens.height;
  camera.lens = {lens.focal, lens.focal, lens.cx, lens.cy};
  if (port.dome)
    camera.port = refractive::DomePort<double>{port.dome->centre, port.dome->inner_radius,
                                               port.thickness,    port.n_air,
                                               port.n_glass,      port.n_water};
  else
    camera.port = refractive::FlatPort<double>{port.normal, port.distance, port.thickness,
                                               port.n_air,  port.n_glass,  port.n_water};
  return camera;
}

// Returns a camera that looks at the middle of the floor from a distance of 1 m. The direction to
// the camera is 35 degrees from the z axis, at the azimuth `angle` [rad].
inline simulate::View room_view(double angle) {
  constexpr double kTilt = 35 * std::numbers::pi / 180;
  simulate::View view;
  view.centre = {std::sin(kTilt) * std::cos(angle), std::sin(kTilt) * std::sin(angle),
                 std::cos(kTilt)};
  const Eigen::Vector3d z = -view.centre.normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  view.rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
  return view;
}

// Returns photographs by `count` cameras around the room. The brightness of view v is multiplied by
// exposures[v], if `exposures` is not empty.
inline Room photograph_room(int count, const std::vector<float>& exposures = {},
                            const simulate::Port& port = room_port()) {
  const Mesh mesh = room_mesh();
  const simulate::RayScene scene({mesh.vertices, mesh.faces});
  const simulate::Lens lens = simulate::make_lens(240, 180, 65);
  Room room;
  for (int v = 0; v < count; ++v) {
    const float exposure = exposures.empty() ? 1 : exposures[static_cast<std::size_t>(v)];
    const auto shade = [exposure](const simulate::SurfacePoint& point) -> Eigen::Vector3f {
      return exposure * pattern(point.position);
    };
    const simulate::View view = room_view(2 * std::numbers::pi * v / count);
    room.views.push_back({camera_of(lens, port), {view.rotation, view.centre}});
    room.images.push_back(
        {simulate::develop(simulate::render_radiance(scene, shade, lens, &port, view, 3), 0, 0),
         {}});
  }
  return room;
}

// Returns the colour R G B [grey levels] of a face at a point, given by barycentric weights.
// Nothing for a face that no view sees.
inline std::optional<Eigen::Vector3f> color_at(const TexturedMesh& mesh, std::size_t face,
                                               const Eigen::Vector3f& weights) {
  const auto& uv = mesh.uv[face];
  if ((uv[1] - uv[0]).norm() == 0) return {};
  const Eigen::Vector2f at = weights[0] * uv[0] + weights[1] * uv[1] + weights[2] * uv[2];
  return bilinear(mesh.textures[mesh.texture_of[face]], at).reverse();
}

// Calls visit(face, colour, point) for three points inside each face that a view sees.
template <class Visit>
void for_each_color(const TexturedMesh& mesh, Visit&& visit) {
  for (std::size_t f = 0; f < mesh.mesh.faces.size(); ++f)
    for (const Eigen::Vector3f& w :
         {Eigen::Vector3f(1, 1, 1), Eigen::Vector3f(4, 1, 1), Eigen::Vector3f(1, 1, 4)}) {
      const Eigen::Vector3f weights = w / w.sum();
      const auto color = color_at(mesh, f, weights);
      if (!color) continue;
      Eigen::Vector3f point = Eigen::Vector3f::Zero();
      for (int k = 0; k < 3; ++k)
        point += weights[k] * mesh.mesh.vertices[mesh.mesh.faces[f][static_cast<std::size_t>(k)]];
      visit(f, *color, Eigen::Vector3d(point.cast<double>()));
    }
}

// Returns the errors of the colours in ascending order. An error is the largest difference in a
// channel between the colour of the mesh and pattern() [grey levels].
inline std::vector<float> color_errors(const TexturedMesh& mesh) {
  std::vector<float> errors;
  for_each_color(mesh, [&](std::size_t, const Eigen::Vector3f& color, const Eigen::Vector3d& p) {
    errors.push_back((color - 255 * pattern(p)).cwiseAbs().maxCoeff());
  });
  std::sort(errors.begin(), errors.end());
  return errors;
}

inline texture::Options plain_options() {
  texture::Options options;
  options.leveling.global = options.leveling.local = false;
  return options;
}

}  // namespace axial::test
