// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/faces/labels.h"

#include <maxflow/graph.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "geometry/lists.h"

namespace axial::texture {
namespace {

using Graph = maxflow::Graph<int, int, int>;  // the library holds this instance

constexpr int kSeam = 1000;  // the cost of a seam; all costs are integers in this unit

// A view that can be chosen for a face, and its cost.
struct Choice {
  std::uint32_t face;
  int cost;
};

// The neighbours of each face.
geometry::Lists<> neighbours_of(std::size_t faces, std::span<const FacePair> pairs) {
  return geometry::lists_of(faces, [&](const auto& add) {
    for (const FacePair& pair : pairs) {
      add(pair.a, pair.b);
      add(pair.b, pair.a);
    }
  });
}

// The number of sights of each view, up to the last view that has any.
std::vector<std::uint64_t> sights_of_views(const FaceViews& views) {
  std::vector<std::uint64_t> counts;
  for (const Sight& sight : views.sights) {
    if (sight.view >= counts.size()) counts.resize(sight.view + 1, 0);
    ++counts[sight.view];
  }
  return counts;
}

class Expansion {
 public:
  Expansion(const FaceViews& views, std::span<const FacePair> pairs, double ratio)
      : neighbours_(neighbours_of(views.faces(), pairs)),
        label_(views.faces(), kNoView),
        cost_(views.faces(), 0),
        node_(views.faces(), -1) {
    make_room(views);
    for (std::uint32_t f = 0; f < views.faces(); ++f) {
      float best = 0;
      for (const Sight& sight : views.of(f)) best = std::max(best, sight.quality);
      for (const Sight& sight : views.of(f)) {
        const double loss = best > 0 ? 1 - sight.quality / best : 0;
        const int cost = static_cast<int>(std::lround(2 * ratio * kSeam * loss));
        choices_[sight.view].push_back({f, cost});
        if (label_[f] == kNoView || cost < cost_[f]) label_[f] = sight.view, cost_[f] = cost;
      }
    }
    changed_.assign(choices_.size(), true);
  }

  // Expands each view whose faces have changed. Returns whether any face changed.
  bool cycle() {
    bool any = false;
    for (std::uint32_t view = 0; view < choices_.size(); ++view) {
      if (!changed_[view]) continue;
      changed_[view] = false;
      if (!expand(view)) continue;
      any = true;
      for (std::uint32_t other = 0; other < choices_.size(); ++other)
        if (other != view) changed_[other] = true;
    }
    return any;
  }

  std::vector<std::uint32_t> take_labels() { return std::move(label_); }

 private:
  void make_room(const FaceViews& views) {
    const std::vector<std::uint64_t> counts = sights_of_views(views);
    choices_.resize(counts.size());
    for (std::size_t view = 0; view < counts.size(); ++view) choices_[view].reserve(counts[view]);
  }

  // Gives `view` to the set of faces that lowers the sum of costs most. Returns whether there is
  // such a set.
  bool expand(std::uint32_t view) {
    std::vector<Choice> free;
    free.reserve(choices_[view].size());
    for (const Choice& choice : choices_[view])
      if (label_[choice.face] != view) free.push_back(choice);
    if (free.empty()) return false;
    for (std::size_t i = 0; i < free.size(); ++i) node_[free[i].face] = static_cast<int>(i);
    const auto count = static_cast<int>(free.size());
    Graph graph(count, 2 * count, [](const char* text) { fail("minimum cut: {}", text); });
    graph.add_node(count);
    for (const Choice& choice : free) add(graph, view, choice);
    graph.maxflow();
    bool any = false;
    for (const Choice& choice : free) {
      const int node = node_[choice.face];
      node_[choice.face] = -1;
      // In a tie the face keeps its view.
      if (graph.what_segment(node, Graph::SOURCE) == Graph::SOURCE) continue;
      label_[choice.face] = view, cost_[choice.face] = choice.cost;
      any = true;
    }
    return any;
  }

  // A face on the source's side keeps its view, a face on the sink's side gets `view`. The capacity
  // from the source is the cost of the sink's side, and the other way round.
  void add(Graph& graph, std::uint32_t view, const Choice& choice) {
    int keep = cost_[choice.face], change = choice.cost;
    const int node = node_[choice.face];
    for (const std::uint32_t other : neighbours_.of(choice.face)) {
      const std::uint32_t theirs = label_[other];
      if (theirs == kNoView) continue;
      const bool same = theirs == label_[choice.face];
      if (node_[other] < 0) {  // keeps its view, which may be `view`
        if (!same) keep += kSeam;
        if (theirs != view) change += kSeam;
      } else if (node_[other] > node) {
        add_seam(graph, node, node_[other], same);
      }
    }
    graph.add_tweights(node, change, keep);
  }

  // Costs of the sides (this, other): (keep, keep): 0 if `same`, else 1 seam; (keep, change) and
  // (change, keep): 1; (change, change): 0.
  static void add_seam(Graph& graph, int node, int other, bool same) {
    if (same) {
      graph.add_edge(node, other, kSeam, kSeam);
    } else {  // 1 - [this changes] + [this changes and the other keeps]
      graph.add_tweights(node, 0, kSeam);
      graph.add_edge(other, node, kSeam, 0);
    }
  }

  geometry::Lists<> neighbours_;
  std::vector<std::uint32_t> label_;
  std::vector<int> cost_;                     // of the label
  std::vector<int> node_;                     // in the graph of an expansion; -1: none
  std::vector<std::vector<Choice>> choices_;  // of each view
  std::vector<bool> changed_;
};

}  // namespace

std::uint64_t bytes_to_choose_views(const FaceViews& views) {
  std::uint64_t largest = 0;
  for (const std::uint64_t count : sights_of_views(views)) largest = std::max(largest, count);
  // Neighbours while they are listed, label, cost and node.
  const std::uint64_t of_faces = views.faces() * (2 * 4 + 3 * 4 + 3 * 4);
  // The graph has a node for each choice, and room for two edges, which are two arcs each.
  constexpr std::uint64_t kNode = 48, kArc = 32;
  return of_faces + views.sights.size() * sizeof(Choice) +
         largest * (sizeof(Choice) + kNode + 4 * kArc);
}

std::vector<std::uint32_t> choose_views(const FaceViews& views, std::span<const FacePair> pairs,
                                        const LabelOptions& options) {
  if (views.sights.empty()) return std::vector<std::uint32_t>(views.faces(), kNoView);
  Expansion expansion(views, pairs, options.cost_smoothness_ratio);
  for (int i = 0; i < options.max_cycles && expansion.cycle(); ++i) {
  }
  return expansion.take_labels();
}

}  // namespace axial::texture
