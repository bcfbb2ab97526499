// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/terrain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/noise.h"

namespace axial::simulate {
namespace {

// Coordinates of grid lines: about `cell` apart within [-half, half], then in growing steps up to
// about half + skirt.
std::vector<double> grid_lines(double half, double skirt, double cell) {
  const auto inside = static_cast<int>(std::ceil(half / cell));
  std::vector<double> positive;
  for (int i = 1; i <= inside; ++i) positive.push_back(half * i / inside);
  for (double step = cell; positive.back() < half + skirt;) {
    step *= 1.04;
    positive.push_back(positive.back() + step);
  }
  std::vector<double> lines;
  for (auto x = positive.rbegin(); x != positive.rend(); ++x) lines.push_back(-*x);
  lines.push_back(0);
  lines.insert(lines.end(), positive.begin(), positive.end());
  return lines;
}

TriangleMesh floor_mesh(const Terrain& terrain) {
  const auto xs = grid_lines(terrain.half_width, terrain.skirt, terrain.cell);
  const auto ys = grid_lines(terrain.half_height, terrain.skirt, terrain.cell);
  // Rows along x and columns along y make the faces point upwards.
  return grid_mesh(xs.size(), ys.size(), false, [&](std::size_t r, std::size_t c) {
    return Eigen::Vector3d(xs[r], ys[c], terrain.floor.at(xs[r], ys[c]));
  });
}

// Nothing deeper than this below a surface can be visible, because faces are about a cell wide.
double burial(const Terrain& terrain) {
  return 4 * terrain.cell;
}

// The blobs of a terrain, along y: a survey has thousands of them in a long strip.
class BlobsAlongY {
 public:
  explicit BlobsAlongY(const std::vector<Blob>& blobs) {
    for (const Blob& blob : blobs) {
      sorted_.push_back(&blob);
      reach_ = std::max(reach_, Blob::kReach * blob.radii.maxCoeff());
    }
    std::ranges::stable_sort(sorted_, {}, y_of);
  }

  // Whether `p` is inside a blob other than `except`, at least `margin` below its surface.
  bool contain(const Eigen::Vector3d& p, double margin, const Blob* except) const {
    const auto from = std::ranges::lower_bound(sorted_, p.y() - reach_, {}, y_of);
    const auto to = std::ranges::upper_bound(sorted_, p.y() + reach_, {}, y_of);
    return std::any_of(
        from, to, [&](const Blob* blob) { return blob != except && blob->contains(p, margin); });
  }

 private:
  static double y_of(const Blob* blob) { return blob->centre.y(); }

  std::vector<const Blob*> sorted_;
  double reach_ = 0;  // of the largest blob [m]
};

bool below_floor(const Terrain& terrain, const Eigen::Vector3d& p) {
  return p.z() < terrain.floor.at(p.x(), p.y()) - burial(terrain);
}

// Turns a height into stairs of step `layer`. Three quarters of each step are gained between 0.6
// and 0.95 of it.
double stair(double height, double layer) {
  const double steps = std::floor(height / layer);
  const auto within = static_cast<float>(height / layer - steps);
  return layer * (steps + 0.25 * within + 0.75 * smooth_step(0.6f, 0.95f, within));
}

// Ripples with wandering crests, around height 0.
double ripples(const Floor& floor, double x, double y) {
  const Eigen::Vector3d p = Eigen::Vector3d(x, y, 0) / (6 * floor.ripple_length);
  const auto bend = static_cast<double>(fractal_noise(p, floor.seed + 31u, 2, 0.5f));
  const double phase = 2 * std::numbers::pi * (x / floor.ripple_length + 2 * bend);
  return 0.5 * floor.ripple_height * std::sin(phase);
}

}  // namespace

double Floor::at(double x, double y) const {
  const Eigen::Vector3d p = Eigen::Vector3d(x, y, 0.3 * wavelength) / wavelength;
  const float dunes = fractal_noise(p, seed, 7, 0.5f);
  const float ridges = 0.5f - std::abs(fractal_noise(turn_octave(1.7 * p), seed + 77u, 5, 0.5f));
  const auto r = static_cast<float>(std::sqrt(x * x + y * y));
  const float bowl = smooth_step(static_cast<float>(bowl_from), static_cast<float>(bowl_to), r);
  double smooth = height * (dunes + 0.45 * (ridges - 0.3)) + bowl_height * bowl;
  if (ripple_height > 0) smooth += ripples(*this, x, y);
  if (!(layer > 0)) return smooth;
  const double rise = dip.x() * x + dip.y() * y;
  return stair(smooth + rise, layer) - rise;
}

double Growth::at(double x, double y) const {
  if (!(height > 0)) return 0;
  const auto inside = [&](double from_centre, double half_side) {
    const double beyond = std::abs(from_centre) - half_side;
    return 1 - static_cast<double>(smooth_step(static_cast<float>(-0.5 * edge),
                                               static_cast<float>(0.5 * edge),
                                               static_cast<float>(beyond)));
  };
  return height * inside(x - centre.x(), half.x()) * inside(y - centre.y(), half.y());
}

TriangleMesh terrain_mesh(const Terrain& terrain) {
  TriangleMesh mesh = floor_mesh(terrain);
  const BlobsAlongY blobs(terrain.blobs);
  remove_hidden(
      mesh, [&](const Eigen::Vector3d& p) { return blobs.contain(p, burial(terrain), nullptr); });
  const auto add = [&](TriangleMesh part, const Blob* self) {
    remove_hidden(part, [&](const Eigen::Vector3d& p) {
      return below_floor(terrain, p) || blobs.contain(p, burial(terrain), self);
    });
    append(mesh, part);
  };
  for (const Blob& blob : terrain.blobs) add(blob_mesh(blob, terrain.cell), &blob);
  for (const Arch& arch : terrain.arches) add(arch_mesh(arch, terrain.cell), nullptr);
  for (const Tube& tube : terrain.tubes) add(tube_mesh(tube, terrain.cell), nullptr);
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex.z() += static_cast<float>(terrain.growth.at(vertex.x(), vertex.y()));
    vertex.z() *= static_cast<float>(terrain.relief);
  }
  return mesh;
}

}  // namespace axial::simulate
