// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/colors/leveling.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/lists.h"
#include "texture/colors/chart_field.h"

namespace axial::texture {
namespace {

// A side of a seam, in the list of a chart.
struct Side {
  std::uint32_t seam;
  bool is_b;
};

// The seams of each chart.
geometry::Lists<Side> sides_of(const Charts& charts, std::span<const Seam> seams) {
  return geometry::lists_of<Side>(charts.charts.size(), [&](const auto& add) {
    for (std::uint32_t s = 0; s < seams.size(); ++s) {
      add(charts.nodes[seams[s].a[0]].chart, Side{s, false});
      add(charts.nodes[seams[s].b[0]].chart, Side{s, true});
    }
  });
}

// Everything that the correction of a chart depends on.
struct Leveling {
  const Atlas& atlas;
  const Charts& charts;
  std::span<const Seam> seams;
  const SeamColors& colors;
  std::span<const Eigen::Vector3f> global;  // one per node

  Eigen::Vector2f place(std::uint32_t node, std::size_t chart) const {
    return atlas.in_chart(atlas.uv[node], chart);
  }

  ChartField global_field(std::size_t chart) const {
    ChartField field(atlas.rects[chart].size());
    for (const std::uint32_t f : charts.faces.of(chart)) {
      const auto& [a, b, c] = charts.corners[f];
      field.add_triangle({place(a, chart), place(b, chart), place(c, chart)},
                         {global[a], global[b], global[c]});
    }
    for (const std::uint32_t f : charts.faces.of(chart))
      for (const std::uint32_t node : charts.corners[f])
        field.add_point(place(node, chart), global[node]);
    field.widen();
    field.widen();
    return field;
  }

  // Half of the difference that is left along one side of a seam.
  void add_samples(const Side& side, std::size_t chart,
                   std::vector<ChartField::Sample>& samples) const {
    const Seam& seam = seams[side.seam];
    const auto& nodes = side.is_b ? seam.b : seam.a;
    const std::span<const Eigen::Vector3f> differences = colors.of(side.seam);
    const auto n = static_cast<float>(differences.size());
    for (std::size_t k = 0; k < differences.size(); ++k) {
      const float t = (static_cast<float>(k) + 0.5f) / n;
      const auto along = [t](const Eigen::Vector3f& x, const Eigen::Vector3f& y) {
        return ((1 - t) * x + t * y).eval();
      };
      const Eigen::Vector3f left = differences[k] + along(global[seam.b[0]], global[seam.b[1]]) -
                                   along(global[seam.a[0]], global[seam.a[1]]);
      samples.push_back({(1 - t) * place(nodes[0], chart) + t * place(nodes[1], chart),
                         (side.is_b ? -0.5f : 0.5f) * left});
    }
  }
};

std::uint64_t bytes_of_largest_field(const Atlas& atlas) {
  std::uint64_t pixels = 0;
  for (std::size_t c = 0; c < atlas.rects.size(); ++c)
    if (atlas.in_work(c))
      pixels = std::max(pixels, static_cast<std::uint64_t>(atlas.rects[c].area()));
  return bytes_of_field(pixels);
}

std::string work_of(std::span<const Seam> seams) {
  return fmt::format("levelling {} seams", seams.size());
}

}  // namespace

Corrections find_corrections(const Mesh& mesh, const Charts& charts, std::span<const Seam> seams,
                             SeamColors colors, const LevelingOptions& options,
                             const MemoryBudget& budget) {
  budget.require(bytes_to_level_globally(mesh.faces.size(), seams.size(), charts.nodes.size()),
                 work_of(seams));
  Corrections result{std::move(colors), {}};
  if (options.global)
    result.global = level_globally(mesh, charts, seams, result.colors, options.global_options);
  else
    result.global.assign(charts.nodes.size(), Eigen::Vector3f::Zero());
  return result;
}

void level_charts(Atlas& atlas, const Charts& charts, std::span<const Seam> seams,
                  const Corrections& corrections, const LevelingOptions& options,
                  const MemoryBudget& budget) {
  const geometry::Lists<Side> sides = sides_of(charts, seams);
  const Leveling leveling{atlas, charts, seams, corrections.colors, corrections.global};
  const std::size_t in_flight =
      budget.items(bytes_of_largest_field(atlas), thread_count(), work_of(seams));
  for_each_in_flight(charts.charts.size(), in_flight, [&](std::size_t chart) {
    if (!atlas.in_work(chart)) return;
    ChartField field = leveling.global_field(chart);
    std::vector<ChartField::Sample> samples;
    if (options.local)
      for (const Side& side : sides.of(chart)) leveling.add_samples(side, chart, samples);
    field.add_strip(samples, options.strip);
    field.add_to(atlas.pixels(chart));
  });
}

}  // namespace axial::texture
