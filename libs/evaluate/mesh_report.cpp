// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "evaluate/report.h"

namespace axial::evaluate {
namespace {

nlohmann::ordered_json normals_json(const NormalErrors& errors) {
  const bool any = errors.count > 0;
  return {{"count", errors.count},
          {"median", any ? nlohmann::ordered_json(errors.median) : nlohmann::ordered_json()},
          {"within_10_20_30", errors.within}};
}

nlohmann::ordered_json topology_json(const Topology& topology) {
  return {{"vertices", topology.vertices},
          {"faces", topology.faces},
          {"edges", topology.edges},
          {"components", topology.components},
          {"border_edges", topology.border_edges},
          {"border_loops", topology.border_loops},
          {"non_manifold_edges", topology.non_manifold_edges},
          {"non_manifold_vertices", topology.non_manifold_vertices},
          {"inconsistent_edges", topology.inconsistent_edges},
          {"degenerate_faces", topology.degenerate_faces},
          {"self_intersecting_faces", topology.self_intersecting_faces}};
}

std::string normals_row(const char* name, const NormalErrors& errors) {
  const auto& [ten, twenty, thirty] = errors.within;
  return fmt::format("{:<22}{:>10}{:>10.2f}{:>10.4f}{:>10.4f}{:>10.4f}\n", name, errors.count,
                     errors.median, ten, twenty, thirty);
}

std::string topology_rows(const Topology& t) {
  return fmt::format(
      "topology: {} vertices, {} edges, {} faces, {} components, {} border edges in {} loops\n"
      "faults: {} edges of more than two faces, {} non-manifold vertices, {} inconsistently "
      "oriented edges, {} degenerate faces, {} self-intersecting faces\n",
      t.vertices, t.edges, t.faces, t.components, t.border_edges, t.border_loops,
      t.non_manifold_edges, t.non_manifold_vertices, t.inconsistent_edges, t.degenerate_faces,
      t.self_intersecting_faces);
}

}  // namespace

nlohmann::ordered_json to_json(const MeshEvaluation& e) {
  nlohmann::ordered_json report{{"normals", normals_json(e.normals)}};
  if (e.seen)
    report["seen"] = {{"share", e.seen->share},
                      {"accuracy", to_json(e.seen->accuracy)},
                      {"scores", to_json(e.seen->scores)},
                      {"normals", normals_json(e.seen->normals)}};
  if (e.unseen)
    report["unseen"] = {{"share", e.unseen->total()},
                        {"no_view", e.unseen->no_view},
                        {"few_views", e.unseen->few_views},
                        {"far", e.unseen->far}};
  report["topology"] = topology_json(e.topology);
  return report;
}

std::string table(const MeshEvaluation& e) {
  std::string text;
  if (e.seen)
    text += statistics_header("over seen surface") +
            statistics_row("points to truth", e.seen->accuracy) + score_rows(e.seen->scores);
  text += fmt::format("{:<22}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "normals [degrees]", "count",
                      "median", "to 10", "to 20", "to 30") +
          normals_row("all of the mesh", e.normals);
  if (e.seen) text += normals_row("over seen surface", e.seen->normals);
  if (e.unseen)
    text += fmt::format(
        "area over unseen space: {:.4f} of the mesh; no view {:.4f}, too few views {:.4f}, seen "
        "but "
        "with a gross error {:.4f}\n",
        e.unseen->total(), e.unseen->no_view, e.unseen->few_views, e.unseen->far);
  return text + topology_rows(e.topology);
}

}  // namespace axial::evaluate
