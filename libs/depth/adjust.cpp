// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <span>

#include "base/error.h"
#include "base/parallel.h"
#include "depth/filters.h"
#include "depth/views/ray_caster.h"

namespace axial::depth {
namespace {

using Ray = refractive::AxialRay<float>;

void check(const DepthMap& map) {
  const cv::Size size = map.depth.size();
  const auto agrees = [&](const cv::Mat& image) { return image.empty() || image.size() == size; };
  if (size.empty()) fail_in(map.image_path, "the depth map is empty");
  if (map.camera.width != size.width || map.camera.height != size.height || !agrees(map.normal) ||
      !agrees(map.confidence)) {
    fail_in(map.image_path, "the depth map's images and its camera differ in size");
  }
}

float confidence_at(const DepthMap& map, int y, int x) {
  return map.confidence.empty() ? 1.0f : map.confidence(y, x);
}

// The motion from one camera frame to another. It is computed in double, because poses may lie far
// from the origin.
struct Motion {
  Eigen::Matrix3f rotation;
  Eigen::Vector3f translation;

  Motion(const Pose& from, const Pose& to)
      : rotation((to.rotation * from.rotation.transpose()).cast<float>()),
        translation((to.rotation * (from.centre - to.centre)).cast<float>()) {}

  Eigen::Vector3f operator()(const Eigen::Vector3f& X) const { return rotation * X + translation; }
};

// The rays of all pixels of a map, row by row.
std::vector<Ray> rays_of(const DepthMap& map) {
  const auto width = static_cast<std::size_t>(map.width());
  std::vector<Ray> rays(map.depth.total());
  std::visit(
      [&](const auto& camera) {
        const RayCaster caster(camera);
        parallel_for(static_cast<std::size_t>(map.height()), [&](std::size_t y) {
          each_ray_of_row(caster, static_cast<int>(y), map.width(), [&](int x, const Ray& ray) {
            rays[y * width + static_cast<std::size_t>(x)] = ray;
          });
        });
      },
      make_camera<float>(map.camera));
  return rays;
}

// The depth that one neighbour gives to a pixel of the reference.
struct Splat {
  float depth = 0;  // lambda on the reference's ray; 0: none
  float confidence = 0;
  float offset2 = 0;  // squared distance of the projected point from the pixel [px^2]
};

struct Surface {
  Eigen::Vector3f point;   // in the reference's camera frame
  Eigen::Vector3f normal;  // 0: unknown
  float confidence;
};

// The depth at which the pixel's ray meets the surface's tangent plane. The depth of the point
// itself would be the depth of a place up to one and a half pixels away, and the z-buffer would
// always prefer the nearer side of a slope. Without a normal, or at grazing incidence, it is the
// point's position along the ray.
float depth_on(const Ray& ray, const Surface& surface) {
  constexpr float kGrazing = 0.1f;
  const Eigen::Vector3f to_point = surface.point - ray.origin;
  const float slope = ray.direction.dot(surface.normal);
  if (slope > -kGrazing) return to_point.dot(ray.direction);
  return to_point.dot(surface.normal) / slope;
}

// The z-buffer test: of two surfaces the nearer one is kept; of two samples of the same surface,
// the sample whose projection is closer to the pixel is kept.
bool replaces(const Splat& candidate, const Splat& current, float same_surface) {
  if (!(current.depth > 0)) return true;
  if (std::abs(candidate.depth - current.depth) > same_surface * current.depth) {
    return candidate.depth < current.depth;
  }
  return candidate.offset2 < current.offset2;
}

class Canvas {
 public:
  Canvas(cv::Size size, const std::vector<Ray>& rays, float same_surface)
      : size_(size), rays_(rays), same_surface_(same_surface), splats_(rays.size()) {}

  const Splat& at(std::size_t pixel) const { return splats_[pixel]; }
  Splat& at(std::size_t pixel) { return splats_[pixel]; }

  // Draws the surface into the 4 pixels around its projection.
  void draw(const Surface& surface, const Eigen::Vector2f& projection) {
    const float left = std::floor(projection.x()), top = std::floor(projection.y());
    if (!(left >= -1 && top >= -1 && left < static_cast<float>(size_.width) &&
          top < static_cast<float>(size_.height))) {
      return;
    }
    const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
    for (int y = std::max(0, y0); y <= std::min(size_.height - 1, y0 + 1); ++y) {
      for (int x = std::max(0, x0); x <= std::min(size_.width - 1, x0 + 1); ++x) {
        const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                           static_cast<std::size_t>(x);
        Splat candidate;
        candidate.depth = depth_on(rays_[pixel], surface);
        candidate.confidence = surface.confidence;
        const Eigen::Vector2f offset(projection.x() - static_cast<float>(x),
                                     projection.y() - static_cast<float>(y));
        candidate.offset2 = offset.squaredNorm();
        if (!(candidate.depth > 0)) continue;
        if (replaces(candidate, splats_[pixel], same_surface_)) splats_[pixel] = candidate;
      }
    }
  }

 private:
  cv::Size size_;
  const std::vector<Ray>& rays_;
  float same_surface_;
  std::vector<Splat> splats_;
};

// Calls visit(surface) for each valid pixel in row y of the neighbour, with the surface in the
// reference's frame.
template <class Visit>
void each_surface(const DepthMap& neighbour, int y, const Motion& motion,
                  std::span<const Ray> rays_of_row, Visit&& visit) {
  for (int x = 0; x < neighbour.width(); ++x) {
    const float depth = neighbour.depth(y, x);
    if (!(depth > 0)) continue;
    Surface surface{motion(rays_of_row[static_cast<std::size_t>(x)].at(depth)),
                    Eigen::Vector3f::Zero(), confidence_at(neighbour, y, x)};
    if (!neighbour.normal.empty()) {
      const cv::Vec3f n = neighbour.normal(y, x);
      surface.normal = motion.rotation * Eigen::Vector3f(n[0], n[1], n[2]);
    }
    visit(surface);
  }
}

// Alternates between the two cameras row by row. So std::visit is not needed for pairs of camera
// types.
void draw_neighbour(const DepthMap& neighbour, const DepthMap& reference, Canvas& canvas) {
  const Motion motion(neighbour.pose, reference.pose);
  const auto from = make_camera<float>(neighbour.camera), to = make_camera<float>(reference.camera);
  std::vector<Ray> rays(static_cast<std::size_t>(neighbour.width()));
  for (int y = 0; y < neighbour.height(); ++y) {
    std::visit(
        [&](const auto& camera) {
          for (std::size_t x = 0; x < rays.size(); ++x)
            rays[x] = camera.ray({static_cast<float>(x), static_cast<float>(y)});
        },
        from);
    std::visit(
        [&](const auto& camera) {
          each_surface(neighbour, y, motion, rays, [&](const Surface& surface) {
            const auto projection = camera.project(surface.point);
            if (projection.visible) canvas.draw(surface, projection.pixel);
          });
        },
        to);
  }
}

// Where the neighbour's surface lies behind a point of the reference, the neighbour sees through
// the point. The observation that contradicts the point is then the neighbour's pixel onto which
// the point projects. The confidence of this pixel replaces the confidence of the splat.
void weigh_contradictions(const DepthMap& neighbour, const DepthMap& reference,
                          const std::vector<Ray>& rays, float same_surface, Canvas& canvas) {
  const Motion motion(reference.pose, neighbour.pose);
  const auto* depths = reference.depth.ptr<float>();
  std::visit(
      [&](const auto& camera) {
        for (std::size_t pixel = 0; pixel < rays.size(); ++pixel) {
          const float depth = depths[pixel];
          Splat& splat = canvas.at(pixel);
          if (!(depth > 0) || !(splat.depth - depth >= same_surface * depth)) continue;
          const auto projection = camera.project(motion(rays[pixel].at(depth)));
          const float u = std::floor(projection.pixel.x() + 0.5f);
          const float v = std::floor(projection.pixel.y() + 0.5f);
          const bool inside = u >= 0 && v >= 0 && u < static_cast<float>(neighbour.width()) &&
                              v < static_cast<float>(neighbour.height());
          if (!projection.visible || !inside) continue;
          const int x = static_cast<int>(u), y = static_cast<int>(v);
          if (neighbour.depth(y, x) > 0) splat.confidence = confidence_at(neighbour, y, x);
        }
      },
      make_camera<float>(neighbour.camera));
}

// The sums of the neighbours' weights at one pixel of the reference.
struct Votes {
  float agreement, contradiction = 0, weighted_depth;
  int agreeing = 0, disagreeing = 0;

  Votes(float depth, float confidence)
      : agreement(confidence), weighted_depth(depth * confidence) {}
};

struct Adjuster {
  const DepthMap& reference;
  const AdjustOptions& options;
  std::vector<Ray> rays;
  std::vector<Canvas> canvases;

  Votes votes_at(int y, int x, std::size_t pixel) const {
    const float depth = reference.depth(y, x);
    Votes votes(depth, confidence_at(reference, y, x));
    for (const Canvas& canvas : canvases) {
      const Splat& splat = canvas.at(pixel);
      if (!(splat.depth > 0)) continue;
      if (std::abs(depth - splat.depth) < options.max_difference * depth) {
        votes.weighted_depth += splat.depth * splat.confidence;
        votes.agreement += splat.confidence;
        ++votes.agreeing;
      } else {
        votes.contradiction += splat.confidence;
        ++votes.disagreeing;
      }
    }
    return votes;
  }

  bool keeps(const Votes& votes, float depth) const {
    const int seeing = std::min(options.min_seeing, static_cast<int>(canvases.size()));
    if (votes.agreeing < options.min_agreeing) return false;
    if (votes.agreeing + votes.disagreeing < seeing) return false;
    if (!(votes.agreement > votes.contradiction)) return false;
    return !(reference.max_depth > 0) ||
           (depth >= reference.min_depth && depth <= reference.max_depth);
  }

  void adjust_row(int y, DepthMap& result) const {
    for (int x = 0; x < reference.width(); ++x) {
      const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(reference.width()) +
                         static_cast<std::size_t>(x);
      if (!(reference.depth(y, x) > 0)) continue;
      const Votes votes = votes_at(y, x, pixel);
      const float depth = votes.weighted_depth / votes.agreement;
      if (keeps(votes, depth)) {
        result.depth(y, x) = depth;
        result.confidence(y, x) = votes.agreement - votes.contradiction;
      } else if (!result.normal.empty()) {
        result.normal(y, x) = {0, 0, 0};
      }
    }
  }
};

}  // namespace

DepthMap adjust_with_neighbours(const DepthMap& reference, std::span<const DepthMap> neighbours,
                                const AdjustOptions& options) {
  check(reference);
  if (!reference.depth.isContinuous())
    fail_in(reference.image_path, "the depth map is a part of a larger depth map");
  neighbours = neighbours.first(std::min(neighbours.size(), options.max_neighbours));
  Adjuster adjuster{reference, options, rays_of(reference), {}};
  for (const DepthMap& neighbour : neighbours) {
    check(neighbour);
    adjuster.canvases.emplace_back(reference.depth.size(), adjuster.rays, options.max_difference);
  }
  parallel_for(neighbours.size(), [&](std::size_t n) {
    draw_neighbour(neighbours[n], reference, adjuster.canvases[n]);
    weigh_contradictions(neighbours[n], reference, adjuster.rays, options.max_difference,
                         adjuster.canvases[n]);
  });

  DepthMap result = reference;
  result.depth = cv::Mat1f(reference.depth.size(), 0.0f);
  result.normal = reference.normal.clone();
  result.confidence = cv::Mat1f(reference.depth.size(), 0.0f);
  parallel_for(static_cast<std::size_t>(reference.height()),
               [&](std::size_t y) { adjuster.adjust_row(static_cast<int>(y), result); });
  return result;
}

std::uint64_t bytes_needed(const AdjustSize& size) {
  // Rays and the result; for each neighbour its surface on the pixels of the reference.
  return size.pixels * (sizeof(Ray) + size.neighbours * sizeof(Splat)) + bytes_of_map(size.pixels);
}

}  // namespace axial::depth
