// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/filters.h"

#include <algorithm>
#include <cmath>

namespace axial::depth {
namespace {

// A copy of the map with its own depths, normals and confidences.
DepthMap editable(const DepthMap& map) {
  DepthMap copy = map;
  copy.depth = map.depth.clone();
  copy.normal = map.normal.clone();
  copy.confidence = map.confidence.clone();
  return copy;
}

void clear_pixel(DepthMap& map, int y, int x) {
  map.depth(y, x) = 0;
  if (!map.normal.empty()) map.normal(y, x) = {0, 0, 0};
  if (!map.confidence.empty()) map.confidence(y, x) = 0;
}

// Sets `segment` to the pixels of the segment that contains `seed`, and marks them in `seen`.
void collect_segment(const DepthMap& map, cv::Point seed, float max_difference, cv::Mat1b& seen,
                     std::vector<cv::Point>& segment) {
  segment.assign(1, seed);
  seen(seed) = 1;
  for (std::size_t next = 0; next < segment.size(); ++next) {
    const cv::Point p = segment[next];
    const float depth = map.depth(p);
    for (const cv::Point step : {cv::Point(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
      const cv::Point q = p + step;
      if (q.x < 0 || q.y < 0 || q.x >= map.width() || q.y >= map.height() || seen(q)) continue;
      const float other = map.depth(q);
      // Relative to the smaller depth. So the test is symmetric, and a segment does not depend on
      // its first pixel.
      if (!(other > 0) || std::abs(other - depth) >= max_difference * std::min(other, depth)) {
        continue;
      }
      seen(q) = 1;
      segment.push_back(q);
    }
  }
}

// One row or column of a map; pixels are addressed by their index along it.
struct Line {
  DepthMap& map;
  const cv::Mat1b& mask;
  bool along_row;
  int fixed;

  int size() const { return along_row ? map.width() : map.height(); }
  cv::Point at(int i) const { return along_row ? cv::Point(i, fixed) : cv::Point(fixed, i); }
  bool masked(int i) const { return !mask.empty() && mask(at(i)); }
};

// Fills the invalid pixels between the valid pixels `begin` and `end`, except for masked ones.
void fill_run(Line& line, int begin, int end) {
  DepthMap& map = line.map;
  const cv::Point a = line.at(begin), b = line.at(end);
  for (int i = begin + 1; i < end; ++i) {
    if (line.masked(i)) continue;
    const cv::Point p = line.at(i);
    const float t = static_cast<float>(i - begin) / static_cast<float>(end - begin);
    map.depth(p) = 1.0f / ((1.0f - t) / map.depth(a) + t / map.depth(b));
    if (!map.normal.empty()) {
      const cv::Vec3f sum = (1.0f - t) * map.normal(a) + t * map.normal(b);
      const float norm = std::sqrt(sum.dot(sum));
      map.normal(p) = norm > 0 ? sum * (1.0f / norm) : cv::Vec3f(0, 0, 0);
    }
    if (!map.confidence.empty()) {
      map.confidence(p) = std::min(map.confidence(a), map.confidence(b));
    }
  }
}

void fill_line(Line line, const GapOptions& options) {
  int last = -1;  // the last valid pixel
  for (int i = 0; i < line.size(); ++i) {
    const float depth = line.map.depth(line.at(i));
    if (!(depth > 0)) continue;
    const int gap = i - last - 1;
    if (last >= 0 && gap > 0 && gap <= options.max_gap) {
      const float before = line.map.depth(line.at(last));
      if (std::abs(depth - before) < options.max_difference * std::min(depth, before)) {
        fill_run(line, last, i);
      }
    }
    last = i;
  }
}

}  // namespace

DepthMap remove_speckles(const DepthMap& map, const SpeckleOptions& options) {
  DepthMap result = editable(map);
  cv::Mat1b seen(map.depth.size(), 0);
  std::vector<cv::Point> segment;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (seen(y, x) || !(map.depth(y, x) > 0)) continue;
      collect_segment(map, {x, y}, options.max_difference, seen, segment);
      if (segment.size() >= static_cast<std::size_t>(std::max(0, options.min_pixels))) continue;
      for (const cv::Point p : segment) clear_pixel(result, p.y, p.x);
    }
  }
  return result;
}

DepthMap fill_gaps(const DepthMap& map, const GapOptions& options, const cv::Mat1b& mask) {
  DepthMap result = editable(map);
  for (int y = 0; y < map.height(); ++y) fill_line({result, mask, true, y}, options);
  for (int x = 0; x < map.width(); ++x) fill_line({result, mask, false, x}, options);
  return result;
}

}  // namespace axial::depth
