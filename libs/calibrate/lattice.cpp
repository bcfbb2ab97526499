// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/plane_cross.h"

namespace axial::calibrate {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// The neighbours of a saddle along both edges, against and along their directions.
using Links = std::array<std::array<std::size_t, 2>, 2>;

Eigen::Vector2d turned(const Eigen::Vector2d& direction) {
  return {-direction.y(), direction.x()};
}

class Linker {
 public:
  Linker(const cv::Mat1f& smooth, std::span<const Saddle> saddles)
      : smooth_(smooth), saddles_(saddles), links_(saddles.size()) {
    for (std::size_t i = 0; i < saddles.size(); ++i)
      for (std::size_t edge = 0; edge < 2; ++edge)
        for (std::size_t way = 0; way < 2; ++way)
          links_[i][edge][way] = neighbour(i, edge, way == 0 ? -1 : 1);
  }

  // The neighbour of saddle `i` along the side of its edge that points in `direction`. Saddle `i`
  // is also the neighbour of the result. kNone if there is none.
  std::size_t along(std::size_t i, std::size_t edge, const Eigen::Vector2d& direction) const {
    const std::size_t next = link(i, edge, direction);
    if (next == kNone || link(next, 1 - edge, -direction) != i) return kNone;
    return next;
  }

 private:
  std::size_t link(std::size_t i, std::size_t edge, const Eigen::Vector2d& direction) const {
    return links_[i][edge][saddles_[i].edges[edge].dot(direction) > 0 ? 1 : 0];
  }

  std::size_t neighbour(std::size_t i, std::size_t edge, double sign) const {
    const Eigen::Vector2d direction = sign * saddles_[i].edges[edge];
    std::size_t nearest = kNone;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < saddles_.size(); ++j) {
      const double distance = (saddles_[j].pixel - saddles_[i].pixel).norm();
      if (distance < least && continues(i, j, edge, direction)) nearest = j, least = distance;
    }
    if (nearest == kNone || !edge_between(i, nearest, edge)) return kNone;
    return nearest;
  }

  // True if saddle `j` lies on the edge of saddle `i` and has this edge, too, with dark and bright
  // sides exchanged.
  bool continues(std::size_t i, std::size_t j, std::size_t edge,
                 const Eigen::Vector2d& direction) const {
    constexpr double kAside = 0.2;      // tangent of the angle between the edge and the way to `j`
    constexpr double kParallel = 0.94;  // cosine of the angle between the edges of `i` and `j`
    constexpr double kAcross = 0.8;
    constexpr double kLeastRatio = 0.3;  // of the contrasts
    const double contrast = saddles_[i].contrast, other = saddles_[j].contrast;
    if (std::min(contrast, other) < kLeastRatio * std::max(contrast, other)) return false;
    const Eigen::Vector2d way = saddles_[j].pixel - saddles_[i].pixel;
    const double ahead = way.dot(direction);
    if (ahead < kSaddleRadius || std::abs(plane_cross(way, direction)) > kAside * ahead)
      return false;
    const auto cosine = [&](std::size_t of_i) {
      return std::abs(saddles_[i].edges[of_i].dot(saddles_[j].edges[1 - of_i]));
    };
    return cosine(edge) > kParallel && cosine(1 - edge) > kAcross;
  }

  // True if the photograph shows the edge on the way between both saddles, with the bright side on
  // the same hand everywhere.
  bool edge_between(std::size_t i, std::size_t j, std::size_t edge) const {
    const Eigen::Vector2d way = saddles_[j].pixel - saddles_[i].pixel;
    // Seen along either direction of the first edge, the right side is bright.
    Eigen::Vector2d to_bright = turned(way.normalized());
    if (edge == 1) to_bright = -to_bright;
    const double least = kLeastShare * std::min(saddles_[i].contrast, saddles_[j].contrast);
    for (const double share : {0.3, 0.5, 0.7}) {
      const Eigen::Vector2d on_edge = saddles_[i].pixel + share * way;
      constexpr double kAside = kSaddleRadius - 1;
      if (grey(on_edge + kAside * to_bright) - grey(on_edge - kAside * to_bright) < least)
        return false;
    }
    return true;
  }

  double grey(const Eigen::Vector2d& at) const {
    return smooth_(std::clamp(static_cast<int>(std::lround(at.y())), 0, smooth_.rows - 1),
                   std::clamp(static_cast<int>(std::lround(at.x())), 0, smooth_.cols - 1));
  }

  static constexpr double kLeastShare = 0.4;

  const cv::Mat1f& smooth_;
  std::span<const Saddle> saddles_;
  std::vector<Links> links_;
};

// Collects the saddles that are connected with a first one.
class Lattice {
 public:
  Lattice(const Linker& linker, std::span<const Saddle> saddles, std::vector<bool>& taken,
          std::size_t first)
      : linker_(linker), saddles_(saddles), taken_(taken) {
    const Eigen::Vector2d x = saddles[first].edges[0], y = saddles[first].edges[1];
    add({0, 0}, {first, 0, {x, plane_cross(x, y) > 0 ? y : Eigen::Vector2d(-y)}});
    std::size_t done = 0;
    while (done < order_.size()) {  // grow() adds to the order
      const Cell cell = order_[done++];
      for (std::size_t axis = 0; axis < 2; ++axis)
        for (const int sign : {-1, 1}) grow(cell, axis, sign);
    }
  }

  // The corners of complete cells.
  std::vector<LatticeCorner> corners() const {
    std::vector<LatticeCorner> complete;
    for (const auto& [cell, node] : nodes_)
      if (in_cell({cell.first, cell.second}))
        complete.push_back({{cell.first, cell.second}, node.saddle});
    return complete;
  }

 private:
  struct Node {
    std::size_t saddle = 0;
    std::size_t edge_of_x = 0;              // the edge of the saddle that runs along x
    std::array<Eigen::Vector2d, 2> axes{};  // unit directions of x and y in the photograph
  };
  using Cell = std::pair<int, int>;

  void add(const Cell& cell, const Node& node) {
    nodes_[cell] = node;
    order_.push_back(cell);
    taken_[node.saddle] = true;
  }

  void grow(Cell from, std::size_t axis, int sign) {
    const Cell to(from.first + (axis == 0 ? sign : 0), from.second + (axis == 1 ? sign : 0));
    if (nodes_.contains(to)) return;
    const Node& node = nodes_.at(from);
    const std::size_t edge = axis == 0 ? node.edge_of_x : 1 - node.edge_of_x;
    const std::size_t next = linker_.along(node.saddle, edge, sign * node.axes[axis]);
    if (next == kNone || taken_[next]) return;
    Node added{next, 1 - node.edge_of_x, {}};
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t its_edge = k == 0 ? added.edge_of_x : 1 - added.edge_of_x;
      const Eigen::Vector2d& line = saddles_[next].edges[its_edge];
      added.axes[k] = line.dot(node.axes[k]) > 0 ? line : Eigen::Vector2d(-line);
    }
    add(to, added);
  }

  bool in_cell(const Eigen::Vector2i& at) const {
    for (const int x : {at.x() - 1, at.x()})
      for (const int y : {at.y() - 1, at.y()})
        if (nodes_.contains({x, y}) && nodes_.contains({x + 1, y}) && nodes_.contains({x, y + 1}) &&
            nodes_.contains({x + 1, y + 1}))
          return true;
    return false;
  }

  const Linker& linker_;
  std::span<const Saddle> saddles_;
  std::vector<bool>& taken_;
  std::map<Cell, Node> nodes_;
  std::vector<Cell> order_;
};

}  // namespace

std::vector<LatticeCorner> largest_lattice(const cv::Mat1f& smooth,
                                           std::span<const Saddle> saddles) {
  const Linker linker(smooth, saddles);
  std::vector<bool> taken(saddles.size());
  std::vector<LatticeCorner> largest;
  for (std::size_t first = 0; first < saddles.size(); ++first) {
    if (taken[first]) continue;
    std::vector<LatticeCorner> corners = Lattice(linker, saddles, taken, first).corners();
    if (corners.size() > largest.size()) largest = std::move(corners);
  }
  return largest;
}

}  // namespace axial::calibrate
