// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/region_outlines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/parallel.h"

namespace axial::geometry {
namespace {

// The samples of a grid, with a rim of one sample that is outside.
class Samples {
 public:
  Samples(const SampleGrid& grid, const IsInside& is_inside)
      : grid_(grid), is_inside_(is_inside), inside_(grid.rows + 2, grid.columns + 2, uchar{0}) {
    parallel_for(static_cast<std::size_t>(grid.rows), [&](std::size_t row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < grid.columns; ++x)
        inside_(y + 1, x + 1) = is_inside(grid.at(x, y)) ? 255 : 0;
    });
  }

  // Samples at half the step of `coarse`, in the grid halved(). A place between samples that agree
  // is as they are: it is not looked at.
  Samples(const SampleGrid& grid, const Samples& coarse)
      : grid_(grid),
        is_inside_(coarse.is_inside_),
        inside_(grid.rows + 2, grid.columns + 2, uchar{0}) {
    parallel_for(static_cast<std::size_t>(grid.rows), [&](std::size_t row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < grid.columns; ++x) {
        const cv::Point low(x / 2, y / 2), high((x + 1) / 2, (y + 1) / 2);
        const bool first = coarse.at(low);
        const bool agree = first == coarse.at(high) && first == coarse.at({high.x, low.y}) &&
                           first == coarse.at({low.x, high.y});
        inside_(y + 1, x + 1) = (agree ? first : is_inside_(grid.at(x, y))) ? 255 : 0;
      }
    });
  }

  // -1 and the number of columns or rows are the rim.
  bool at(cv::Point sample) const { return inside_(sample.y + 1, sample.x + 1) != 0; }

  bool reaches_rim() const {
    const int x = inside_.cols - 2, y = inside_.rows - 2;
    return cv::countNonZero(inside_.row(1)) + cv::countNonZero(inside_.row(y)) +
               cv::countNonZero(inside_.col(1)) + cv::countNonZero(inside_.col(x)) >
           0;
  }

  // The last place of the region on the way from a sample inside to its neighbour outside [steps].
  Eigen::Vector2d border(cv::Point inside, cv::Point outside) const {
    const Eigen::Vector2d from(inside.x, inside.y), way(outside.x - inside.x, outside.y - inside.y);
    double low = 0, high = 1;
    for (int i = 0; i < 7; ++i) {
      const double middle = (low + high) / 2;
      const Eigen::Vector2d place = from + middle * way;
      (is_inside_(grid_.at(place.x(), place.y())) ? low : high) = middle;
    }
    return from + low * way;
  }

 private:
  SampleGrid grid_;
  const IsInside& is_inside_;
  cv::Mat1b inside_;
};

// A step from a sample inside to its neighbour outside: the outline crosses it.
struct Crossing {
  cv::Point inside, outside;
};

std::uint64_t key_of(const Crossing& crossing) {
  const auto number = [](int value) { return static_cast<std::uint64_t>(value + 1); };
  const cv::Point way = crossing.outside - crossing.inside;
  const std::uint64_t direction = way.x != 0 ? (way.x > 0 ? 0 : 1) : (way.y > 0 ? 2 : 3);
  return (number(crossing.inside.y) << 32) | (number(crossing.inside.x) << 2) | direction;
}

// The segments of the outline between two crossings, in the squares between four samples. The
// region lies to the left of them.
class Segments {
 public:
  Segments(const Samples& samples, const SampleGrid& grid) {
    for (int y = -1; y < grid.rows; ++y)
      for (int x = -1; x < grid.columns; ++x) add_square(samples, {x, y});
  }

  // Calls use(crossings) for each closed line.
  template <class Use>
  void each_line(const Use& use) {
    for (const Crossing& first : starts_) {
      std::vector<Crossing> line;
      for (auto at = next_.find(key_of(first)); at != next_.end();
           at = next_.find(key_of(line.back()))) {
        line.push_back(at->second);
        next_.erase(at);
      }
      if (!line.empty()) use(line);
    }
  }

 private:
  void add_square(const Samples& samples, cv::Point corner) {
    const std::array<cv::Point, 4> corners{corner, corner + cv::Point(1, 0),
                                           corner + cv::Point(1, 1), corner + cv::Point(0, 1)};
    const auto is_inside = [&](std::size_t k) { return samples.at(corners[k % 4]); };
    for (std::size_t k = 0; k < 4; ++k) {
      if (is_inside(k) || !is_inside(k + 1)) continue;
      std::size_t last = k + 1;
      while (is_inside(last + 1)) ++last;
      const Crossing begin{corners[last % 4], corners[(last + 1) % 4]};
      next_[key_of(begin)] = {corners[(k + 1) % 4], corners[k]};
      starts_.push_back(begin);
    }
  }

  std::unordered_map<std::uint64_t, Crossing> next_;  // the end of the segment that begins there
  std::vector<Crossing> starts_;                      // of all segments, in their order
};

using Line = std::vector<cv::Point2f>;  // [steps]

// A closed line of the outline: all places of crossings, and the corners of the ring.
struct Outline {
  Line places, corners;
  double area = 0;  // of the places; below 0: a hole
  Eigen::AlignedBox2f box;

  // Whether the line goes around a hole. With all places, lines of one region do not cross.
  bool is_around(const Outline& hole) const {
    const cv::Point2f place = hole.places.front();
    return box.contains(Eigen::Vector2f(place.x, place.y)) &&
           cv::pointPolygonTest(places, place, false) >= 0;
  }
};

Outline outline_of(const std::vector<Crossing>& crossings, const Samples& samples) {
  constexpr double kStraight = 0.02;
  Outline outline;
  outline.places.resize(crossings.size());
  parallel_for(
      crossings.size(),
      [&](std::size_t i) {
        const Eigen::Vector2d place = samples.border(crossings[i].inside, crossings[i].outside);
        outline.places[i] = {static_cast<float>(place.x()), static_cast<float>(place.y())};
      },
      64);
  for (const cv::Point2f& place : outline.places)
    outline.box.extend(Eigen::Vector2f(place.x, place.y));
  outline.area = cv::contourArea(outline.places, true);
  cv::approxPolyDP(outline.places, outline.corners, kStraight, true);
  return outline;
}

Ring ring_of(const Outline& outline, const SampleGrid& grid) {
  Ring ring;
  for (const cv::Point2f& corner : outline.corners) ring.push_back(grid.at(corner.x, corner.y));
  return ring;
}

// Gives each hole to the smallest outline around it.
std::vector<std::vector<Ring>> parts_of(const std::vector<Outline>& outlines,
                                        const std::vector<Outline>& holes, const SampleGrid& grid) {
  std::vector<std::vector<Ring>> parts;
  for (const Outline& outline : outlines) parts.push_back({ring_of(outline, grid)});
  for (const Outline& hole : holes) {
    std::size_t around = outlines.size();
    for (std::size_t i = 0; i < outlines.size(); ++i)
      if ((around == outlines.size() || outlines[i].area < outlines[around].area) &&
          outlines[i].is_around(hole))
        around = i;
    if (around < outlines.size()) parts[around].push_back(ring_of(hole, grid));
  }
  return parts;
}

SampleGrid grown(SampleGrid grid) {
  const int more = std::max(2, std::max(grid.columns, grid.rows) / 4);
  grid.first -= grid.step * Eigen::Vector2d(more, more);
  grid.columns += 2 * more;
  grid.rows += 2 * more;
  return grid;
}

SampleGrid halved(SampleGrid grid) {
  grid.step /= 2;
  grid.columns = 2 * grid.columns - 1;
  grid.rows = 2 * grid.rows - 1;
  return grid;
}

double samples_of(const SampleGrid& grid) {
  return static_cast<double>(grid.columns) * grid.rows;
}

}  // namespace

std::vector<std::vector<Ring>> region_outlines(SampleGrid grid, const IsInside& is_inside,
                                               double most) {
  if (grid.columns < 1 || grid.rows < 1) return {};
  std::optional<Samples> samples(std::in_place, grid, is_inside);
  while (samples->reaches_rim() && samples_of(grown(grid)) <= most) {
    grid = grown(grid);
    samples.emplace(grid, is_inside);
  }
  const SampleGrid half = halved(grid);
  const Samples fine(half, *samples);
  std::vector<Outline> outlines, holes;
  Segments(fine, half).each_line([&](const std::vector<Crossing>& crossings) {
    Outline outline = outline_of(crossings, fine);
    // A line that turns around when it is simplified is thinner than the error.
    if (outline.corners.size() < 3 || !(outline.area * cv::contourArea(outline.corners, true) > 0))
      return;
    (outline.area < 0 ? holes : outlines).push_back(std::move(outline));
  });
  return parts_of(outlines, holes, half);
}

}  // namespace axial::geometry
