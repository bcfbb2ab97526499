// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/projection_error.h"

#include <cmath>

#include "base/hash.h"
#include "base/parallel.h"
#include "refractive/line_search.h"

namespace axial::experiments {
namespace {

using refractive::LineSearchCamera;

// Upper ends of the bins [px]: errors of Algorithm 1 are up to about a pixel, errors of float are
// some ten-thousandths.
constexpr double kLineSearchUpper = 1.25, kExactUpper = 5e-4;
constexpr std::size_t kBins = 250;
constexpr std::size_t kBlocks = 64;  // blocks of rows, a fixed number for any number of threads

ProjectionErrors no_errors() {
  return {{Distribution(kLineSearchUpper, kBins), 0}, {Distribution(kExactUpper, kBins), 0}};
}

double drawn_distance(std::uint64_t number) {
  constexpr double kNearest = 0.5, kRatio = 20;
  return kNearest * std::pow(kRatio, static_cast<double>(unit_float(scramble(number))));
}

template <class Camera>
void round_trip(const Camera& camera, const Vector3<double>& X, const Vector2<double>& truth,
                RoundTrips& trips) {
  using T = typename Camera::Scalar;
  const refractive::Projection<T> image = camera.project(X.template cast<T>());
  if (image.visible)
    trips.errors.add((image.pixel.template cast<double>() - truth).norm());
  else
    ++trips.missed;
}

}  // namespace

ProjectionErrors projection_errors(const CameraSetup& setup, int size, double step) {
  const LineSearchCamera<double> papers(make_lens(setup, size, size), make_port(setup), size, size);
  const FlatPortCamera<float> ours(make_lens(setup, size, size).cast<float>(),
                                   make_port(setup).cast<float>(), size, size);
  const auto steps = static_cast<std::size_t>(std::lround(std::floor(size / step + 1e-9)));
  const auto place = [&](std::size_t k) { return -0.5 + (static_cast<double>(k) + 0.5) * step; };

  std::vector<ProjectionErrors> blocks(kBlocks, no_errors());
  parallel_for(kBlocks, [&](std::size_t b) {
    for (std::size_t row = steps * b / kBlocks; row < steps * (b + 1) / kBlocks; ++row) {
      for (std::size_t column = 0; column < steps; ++column) {
        const Vector2<double> pixel(place(column), place(row));
        const Vector3<double> X = papers.ray(pixel).at(drawn_distance(row * steps + column));
        round_trip(papers, X, pixel, blocks[b].line_search);
        round_trip(ours, X, pixel, blocks[b].exact);
      }
    }
  });

  ProjectionErrors all = no_errors();
  for (const ProjectionErrors& block : blocks) {
    all.line_search.errors.merge(block.line_search.errors);
    all.line_search.missed += block.line_search.missed;
    all.exact.errors.merge(block.exact.errors);
    all.exact.missed += block.exact.missed;
  }
  return all;
}

}  // namespace axial::experiments
