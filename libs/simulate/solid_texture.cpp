// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/solid_texture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "simulate/noise.h"

namespace axial::simulate {
namespace {

// Brightness variations at all scales. `coarse` holds the wavelengths from the largest patches down
// by five octaves, `fine` the shorter ones down to a pixel. Standard deviations are about 0.4.
struct Detail {
  float coarse = 0;
  float fine = 0;
};

constexpr int kCoarseOctaves = 5;

Detail detail_at(const Eigen::Vector3d& p, double footprint, const TextureOptions& options) {
  Detail d;
  double wavelength = 0.5 * options.largest;
  Eigen::Vector3d q = p / wavelength;
  float coarse_weight = 1.0f;
  for (std::uint32_t k = 0; wavelength > footprint; ++k) {
    const std::uint32_t seed = options.seed + 0x51ed27u * (k + 1);
    // An octave fades in where its wavelength grows from one to two pixels.
    const float fade = smooth_step(1.0f, 2.0f, static_cast<float>(wavelength / footprint));
    const float value = fade * gradient_noise(q, seed);
    if (k < kCoarseOctaves) {
      d.coarse += coarse_weight * value;
      coarse_weight *= 0.75f;
    } else {
      d.fine += value;
    }
    wavelength *= 0.5;
    q = turn_octave(2.0 * q);
  }
  return d;
}

struct Material {
  Eigen::Vector3f color;
  float roughness;  // strength of the fine brightness variations
};

const Material kSediment{{0.60f, 0.54f, 0.42f}, 0.48f};

// The material at a point: patches with ragged borders.
Material material(const Eigen::Vector3d& p, float raggedness, const TextureOptions& options) {
  static const Material kRock{{0.37f, 0.37f, 0.34f}, 0.62f};
  static const Material kAlgae{{0.30f, 0.34f, 0.21f}, 0.66f};
  static const Material kCoral{{0.52f, 0.35f, 0.38f}, 0.56f};
  static const Material kSponge{{0.62f, 0.47f, 0.26f}, 0.50f};
  Material m = kSediment;
  const auto cover = [&](const Material& top, double size, std::uint32_t salt, float threshold) {
    const float field = fractal_noise(p / (size * options.largest), options.seed + salt, 2, 0.5f);
    const float t = smooth_step(threshold - 0.025f, threshold + 0.025f, field + 0.30f * raggedness);
    m.color += t * (top.color - m.color);
    m.roughness += t * (top.roughness - m.roughness);
  };
  cover(kRock, 0.55, 0x1001u, -0.02f);
  cover(kAlgae, 0.37, 0x2003u, 0.19f);
  cover(kCoral, 0.21, 0x3005u, 0.28f);
  cover(kSponge, 0.11, 0x4007u, 0.36f);
  return m;
}

// Pebbles, shells and holes: light and dark spots of three sizes.
float speckles(const Eigen::Vector3d& p, const TextureOptions& options) {
  float sum = 0;
  double wavelength = 0.09 * options.largest;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const float n = gradient_noise(turn_octave(p / wavelength), options.seed + 0x77001u * (k + 1));
    sum += smooth_step(0.30f, 0.42f, n) - smooth_step(0.30f, 0.42f, -n);
    wavelength *= 0.42;
  }
  return sum;
}

struct Seabed {
  const TriangleMesh& mesh;
  const RayScene& scene;
  TextureOptions options;
  std::vector<Eigen::Vector3f> normals;

  Eigen::Vector3f operator()(const SurfacePoint& point) const {
    static const Eigen::Vector3d kSun = Eigen::Vector3d(0.40, 0.28, 0.87).normalized();
    const Eigen::Vector3d normal = smooth_normal(mesh, normals, point.hit);
    const double lift = 0.004 * options.largest;  // keeps a face from shading itself
    const bool lit = point.hit.normal.dot(kSun) > 0 &&
                     !scene.blocked(point.position + lift * point.hit.normal, kSun, 0, 1e3);
    const double direct = lit ? std::max(0.0, normal.dot(kSun)) : 0.0;
    const auto light = static_cast<float>(0.50 + 0.16 * normal.z() + 0.52 * direct);
    return light * seabed_albedo(point.position, point.footprint, options);
  }
};

}  // namespace

Eigen::Vector3f seabed_albedo(const Eigen::Vector3d& p, double footprint,
                              const TextureOptions& options) {
  // Warping the coordinates hides the lattice of the noise and gives patches flowing shapes.
  const Eigen::Vector3d r = p / (0.4 * options.largest);
  const Eigen::Vector3d bend(gradient_noise(r, options.seed + 11u),
                             gradient_noise(r, options.seed + 12u),
                             gradient_noise(r, options.seed + 13u));
  // Detail is warped much less; otherwise it would smear along the flow.
  const Eigen::Vector3d q = p + 0.03 * options.largest * bend;
  const Detail d = detail_at(q, footprint, options);
  const Material m = material(p + 0.2 * options.largest * bend, d.coarse, options);
  const float tone = 1.0f + 0.45f * d.coarse + m.roughness * d.fine + 0.28f * speckles(q, options);
  // The slow warp fields also tint the materials.
  const Eigen::Vector3f tint = Eigen::Vector3f::Ones() + 0.10f * bend.cast<float>();
  const Eigen::Vector3f albedo = m.color.cwiseProduct(tint) * std::clamp(tone, 0.12f, 2.2f);
  if (options.contrast == 1) return albedo;
  return kSediment.color + static_cast<float>(options.contrast) * (albedo - kSediment.color);
}

Shader albedo_shader(const TextureOptions& options) {
  return [options](const SurfacePoint& point) {
    return seabed_albedo(point.position, point.footprint, options);
  };
}

Shader seabed_shader(const TriangleMesh& mesh, const RayScene& scene,
                     const TextureOptions& options) {
  // std::function copies its target, so the normals are shared.
  const auto seabed =
      std::make_shared<const Seabed>(Seabed{mesh, scene, options, vertex_normals(mesh)});
  return [seabed](const SurfacePoint& point) { return (*seabed)(point); };
}

}  // namespace axial::simulate
