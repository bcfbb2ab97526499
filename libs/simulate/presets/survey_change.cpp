// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/presets/survey_change.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "simulate/presets/preset_parts.h"

namespace axial::simulate {
namespace {

// Places of the second survey. Its views are lower and beside those of the first one.
constexpr double kViewsHeight = 2.75;                // [m]
const Eigen::Vector3d kViewsBeside(0.20, -0.12, 0);  // [m]

constexpr double kGrown = 0.020, kHalfPatch = 0.5, kPatchEdge = 0.06;  // [m]
// The middles of everything that changes are within these distances from the world's origin [m].
const Eigen::Vector2d kSeen(1.3, 0.8);
constexpr double kIdealRadius = 0.30;  // of the boulder [m]

// The circle on the ground that a body covers.
struct Footprint {
  Eigen::Vector2d centre;
  double radius = 0;
};

Footprint footprint(const Blob& blob) {
  constexpr double kBumps = 1.25;  // bumps are seldom higher
  return {blob.centre.head<2>(), kBumps * blob.radii.head<2>().maxCoeff()};
}

// Circles along the arches.
std::vector<Footprint> footprints(const std::vector<Arch>& arches) {
  constexpr int kSteps = 4;
  constexpr double kBumps = 1.3;
  std::vector<Footprint> all;
  for (const Arch& arch : arches)
    for (int i = -kSteps; i <= kSteps; ++i)
      all.push_back({arch.centre.head<2>() + arch.span_radius * i / kSteps * arch.along,
                     kBumps * arch.tube_radius});
  return all;
}

// The footprints of all bodies of the terrain except the blob `except`, the first `from` blobs left
// out.
std::vector<Footprint> footprints(const Terrain& terrain, std::size_t except,
                                  std::size_t from = 0) {
  std::vector<Footprint> all = footprints(terrain.arches);
  for (std::size_t i = from; i < terrain.blobs.size(); ++i)
    if (i != except) all.push_back(footprint(terrain.blobs[i]));
  return all;
}

// The distance between two circles; negative if they overlap.
double distance(const Footprint& one, const Footprint& other) {
  return (one.centre - other.centre).norm() - one.radius - other.radius;
}

// The distance of a circle from the nearest one of `others`.
double clearance(const Footprint& circle, const std::vector<Footprint>& others) {
  double least = std::numeric_limits<double>::infinity();
  for (const Footprint& other : others) least = std::min(least, distance(circle, other));
  return least;
}

// The distance of a circle from the rectangle of a patch.
double distance(const Footprint& circle, const Growth& patch) {
  const Eigen::Vector2d beyond =
      ((circle.centre - patch.centre).cwiseAbs() - patch.half).cwiseMax(0);
  return beyond.norm() - 0.5 * patch.edge - circle.radius;
}

// The place on a grid over |x| <= half.x, |y| <= half.y with the highest value of `score`.
template <class Score>
Eigen::Vector2d best_place(const Eigen::Vector2d& half, const Score& score) {
  constexpr int kSteps = 20;
  Eigen::Vector2d best(0, 0);
  double highest = -std::numeric_limits<double>::infinity();
  for (int i = -kSteps; i <= kSteps; ++i)
    for (int j = -kSteps; j <= kSteps; ++j) {
      const Eigen::Vector2d place = half.cwiseProduct(Eigen::Vector2d(i, j)) / kSteps;
      if (const double value = score(place); value > highest) highest = value, best = place;
    }
  return best;
}

// How much of a circle or patch the bodies `others` cover, a rough measure [m^2]: a large body
// hides more than a small one.
template <class Shape>
double covered(const Shape& shape, const std::vector<Footprint>& others) {
  double sum = 0;
  for (const Footprint& other : others)
    sum += std::max(0.0, -distance(other, shape)) * other.radius;
  return sum;
}

// The distance [m] of a body from the ground that many views see.
double outside(const Blob& blob) {
  return (blob.centre.head<2>().cwiseAbs() - 1.2 * kSeen).cwiseMax(0).norm();
}

// The boulder among the first `boulders` blobs that is well seen, free and neither small nor large.
// Error if none of them is on the ground that many views see.
std::size_t choose_boulder(const Terrain& terrain, int boulders) {
  const auto score = [&](std::size_t i) {
    const Blob& blob = terrain.blobs[i];
    return -4 * covered(footprint(blob), footprints(terrain, i)) - 40 * outside(blob) -
           2 * std::abs(blob.radii.maxCoeff() - kIdealRadius);
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < static_cast<std::size_t>(boulders); ++i)
    if (score(i) > score(best)) best = i;
  if (outside(terrain.blobs[best]) > 0)
    fail("the survey shows no boulder that can be moved; choose another seed");
  return best;
}

// Few boulders are in the patch: they have steep sides, but they grow, too.
Growth choose_patch(const Terrain& terrain, std::size_t boulder, int boulders) {
  Growth patch{{0, 0}, {kHalfPatch, kHalfPatch}, kGrown, kPatchEdge};
  const Footprint old = footprint(terrain.blobs[boulder]);
  // Behind the boulders come small ones, mushrooms and arches.
  const std::vector<Footprint> others =
      footprints(terrain, boulder, static_cast<std::size_t>(boulders));
  patch.centre = best_place({kSeen.x(), 0.75 * kSeen.y()}, [&](const Eigen::Vector2d& place) {
    Growth here = patch;
    here.centre = place;
    return 10 * std::min(0.0, distance(old, here) - 0.1) - covered(here, others);
  });
  return patch;
}

// A place for the boulder that is free of everything, also of its old place.
Eigen::Vector2d choose_place(const Terrain& terrain, std::size_t boulder, const Growth& patch) {
  Footprint there = footprint(terrain.blobs[boulder]);
  const std::vector<Footprint> others = footprints(terrain, boulder);
  const std::vector<Footprint> old = {there}, arches = footprints(terrain.arches);
  return best_place(kSeen, [&](const Eigen::Vector2d& place) {
    there.centre = place;
    const double required =
        std::min({distance(there, patch), clearance(there, old), clearance(there, arches)}) - 0.05;
    return 10 * std::min(0.0, required) + std::min(0.1, clearance(there, others));
  });
}

// A blob or an arch.
struct Body {
  std::function<bool(const Eigen::Vector3d&)> contains;  // of a point [world, m]
  Eigen::AlignedBox3d box;                               // around the body [world, m]
  double thickness = 0;                                  // about that of its thinnest part [m]
};

Body body_of(const TriangleMesh& mesh, double thickness,
             std::function<bool(const Eigen::Vector3d&)> contains) {
  Body body{std::move(contains), {}, thickness};
  for (const Eigen::Vector3f& vertex : mesh.vertices) body.box.extend(vertex.cast<double>());
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(0.02 * thickness);
  body.box = {body.box.min() - margin, body.box.max() + margin};
  return body;
}

constexpr double kCell = 0.1;  // of the meshes that give the boxes, in thicknesses

Body body_of(const Blob& blob) {
  const double thickness = blob.radii.minCoeff();
  return body_of(blob_mesh(blob, kCell * thickness), thickness,
                 [blob](const Eigen::Vector3d& p) { return blob.contains(p, 0); });
}

Body body_of(const Arch& arch) {
  return body_of(arch_mesh(arch, kCell * arch.tube_radius), arch.tube_radius,
                 [arch](const Eigen::Vector3d& p) { return arch.contains(p); });
}

// The height of the highest point of a body above (x, y) that is higher than `lowest`; otherwise
// `lowest`.
double top_of(const Body& body, double x, double y, double lowest) {
  const double top = body.box.max().z(), step = body.thickness / 50;
  if (!body.box.contains(Eigen::Vector3d(x, y, top))) return lowest;
  const auto inside = [&](double z) { return body.contains({x, y, z}); };
  for (double z = top; z > std::max(lowest, body.box.min().z()); z -= step) {
    if (!inside(z)) continue;
    double low = z, high = z + step;
    for (int i = 0; i < 20; ++i) {
      const double middle = 0.5 * (low + high);
      (inside(middle) ? low : high) = middle;
    }
    return low;
  }
  return lowest;
}

// What a body adds to the floor and to the bodies `others`.
ChangedPart part_of(const Terrain& terrain, const Body& body, const std::vector<Body>& others,
                    double square) {
  const Eigen::Vector3d size = body.box.sizes();
  const auto columns = static_cast<std::size_t>(std::ceil(size.x() / square)),
             rows = static_cast<std::size_t>(std::ceil(size.y() / square));
  std::vector<double> heights(rows), areas(rows);
  parallel_for(rows, [&](std::size_t row) {
    const double y = body.box.min().y() + (static_cast<double>(row) + 0.5) * square;
    for (std::size_t column = 0; column < columns; ++column) {
      const double x = body.box.min().x() + (static_cast<double>(column) + 0.5) * square;
      const double floor = terrain.floor.at(x, y), top = top_of(body, x, y, floor);
      if (!(top > floor)) continue;
      double rest = floor;
      for (const Body& other : others) rest = std::max(rest, top_of(other, x, y, rest));
      heights[row] += std::max(0.0, top - rest);
      areas[row] += top > rest ? 1 : 0;
    }
  });
  ChangedPart part{0, 0, Eigen::Vector2d::Zero()};
  for (std::size_t row = 0; row < rows; ++row) {
    part.volume += terrain.relief * heights[row] * square * square;
    part.area += areas[row] * square * square;
  }
  return part;
}

// The bodies near `body`, except the blob `except`.
std::vector<Body> beside(const Terrain& terrain, std::size_t except, const Body& body) {
  std::vector<Body> all;
  const double reach = body.box.diagonal().norm();
  const auto is_near = [&](const Eigen::Vector3d& centre, double radius) {
    return (centre - body.box.center()).head<2>().norm() < reach + radius;
  };
  for (std::size_t i = 0; i < terrain.blobs.size(); ++i) {
    const Blob& blob = terrain.blobs[i];
    if (i != except && is_near(blob.centre, Blob::kReach * blob.radii.maxCoeff()))
      all.push_back(body_of(blob));
  }
  for (const Arch& arch : terrain.arches)
    if (is_near(arch.centre, 2 * (arch.span_radius + arch.tube_radius)))
      all.push_back(body_of(arch));
  return all;
}

}  // namespace

void change_survey(Preset& preset, int boulders, std::uint32_t seed) {
  Terrain& terrain = preset.terrain;
  const std::size_t chosen = choose_boulder(terrain, boulders);
  Blob& boulder = terrain.blobs[chosen];
  preset.moved = MovedBoulder{chosen, boulder.centre};
  terrain.growth = choose_patch(terrain, chosen, boulders);
  const Eigen::Vector2d to = choose_place(terrain, chosen, terrain.growth);
  const double above =
      boulder.centre.z() - terrain.floor.at(boulder.centre.x(), boulder.centre.y());
  boulder.centre << to, terrain.floor.at(to.x(), to.y()) + above;
  RandomSequence random(seed + 7000u);
  const int views = static_cast<int>(preset.views.size());
  preset.views.clear();
  add_two_rows(preset, views, kViewsHeight, random);
  for (View& view : preset.views) view.centre += kViewsBeside;
}

ChangeTruth true_change(const Preset& preset) {
  const Terrain& terrain = preset.terrain;
  const Growth& growth = terrain.growth;
  const Blob& there = terrain.blobs[preset.moved->blob];
  Blob here = there;
  here.centre = preset.moved->from;
  const double square = 0.004 * growth.half.x() / kHalfPatch;  // with the scale of the scene
  ChangeTruth truth;
  const auto part = [&](const Blob& blob) {
    const Body body = body_of(blob);
    ChangedPart added = part_of(terrain, body, beside(terrain, preset.moved->blob, body), square);
    added.place = blob.centre.head<2>();
    return added;
  };
  truth.gone = part(here);
  truth.came = part(there);
  // The growth is symmetric about the border of the rectangle, so its volume is that of a box.
  const Eigen::Vector2d sides = 2 * growth.half, outer = sides.array() + growth.edge;
  truth.patch = {terrain.relief * growth.height * sides.prod(), outer.prod(), growth.centre};
  return truth;
}

}  // namespace axial::simulate
