// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/refine.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "base/error.h"
#include "base/log.h"
#include "base/shared_cache.h"
#include "refine/data_term.h"
#include "refine/displace.h"
#include "refine/system.h"

namespace axial::refine {
double env(const char* n, double d) {
  const char* s = std::getenv(n);
  return s ? std::atof(s) : d;
}
namespace {

class Refiner {
 public:
  Refiner(Mesh& mesh, std::span<const View> views,
          const std::vector<std::vector<std::uint32_t>>& sources, const Pictures& pictures,
          const Options& options)
      : mesh_(mesh), views_(views), sources_(sources), pictures_(pictures), options_(options) {}

  Report run() {
    topology_ = topology_of(mesh_);
    for (unsigned scale = options_.scales; scale-- > 0;) {
      const unsigned steps = scale ? unsigned(env("S1", 3)) : unsigned(env("S0", 5));
      for (unsigned k = 0; k < steps; ++k) step(std::pow(options_.scale_step, scale), k == 0);
    }
    return report_;
  }

 private:
  using ImagesCache = SharedCache<std::vector<VertexImage>>;

  void step(double factor, bool first) {
    shape_ = shape_of(mesh_, topology_);
    scaled_.assign(views_.begin(), views_.end());
    for (View& v : scaled_)
      if (v.camera.width > 0)
        v.camera = v.camera.resized(std::max(1, int(std::lround(v.camera.width * factor))),
                                    std::max(1, int(std::lround(v.camera.height * factor))));
    ImagesCache images([&](std::size_t i) { return vertex_images(mesh_.vertices, scaled_[i]); },
                       64);
    if (first) visibility_.emplace(mesh_.vertices.size(), views_.size());
    if (first)
      for (std::size_t i = 0; i < views_.size(); ++i)
        if (views_[i].camera.width > 0)
          mark_seen(*images.get(i), shape_, draw(mesh_, *images.get(i), size_of(i)), i,
                    *visibility_);
    std::vector<FaceEquations> equations(mesh_.faces.size());
    Residuals residuals;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (sources_[i].empty()) continue;
      const auto own = images.get(i);
      const Picture p = picture(i);
      ReferenceView reference(mesh_, shape_, *own, draw(mesh_, *own, size_of(i)), value(p), p.mask);
      for (const std::uint32_t s : sources_[i]) {
        const auto other = images.get(s);
        const Picture q = picture(s);
        const Residuals r = reference.add({*other, value(q), q.mask, s}, i, *visibility_);
        residuals.squared += r.squared;
        residuals.count += r.count;
      }
      reference.finish(equations);
    }
    SystemOptions options;
    options.smoothness = env("LAMBDA", 10);
    if (start_.empty()) start_ = mesh_.vertices;
    std::vector<float> offset(start_.size());
    for (std::size_t v = 0; v < offset.size(); ++v)
      offset[v] = shape_.normals[v].dot(mesh_.vertices[v] - start_[v]);
    options.offset = offset;
    const double mu = env("ANCHOR", 0.5) / std::pow(factor, env("POW", 4)), c = env("C", 9);
    Solution solution = solve(mesh_, topology_, shape_, equations, options);
    std::vector<double> q(offset.size()), anchor(offset.size()), qb;
    for (std::size_t v = 0; v < offset.size(); ++v) {
      double d = 0;
      for (auto f : topology_.faces.of(v))
        for (int k = 0; k < 3; ++k)
          if (mesh_.faces[f][k] == v) d += equations[f].matrix[k == 0 ? 0 : k == 1 ? 3 : 5];
      anchor[v] = d;
      q[v] = std::pow(offset[v] + solution.displacement[v], 2) * d / c;
      if (d > 0) qb.push_back(d);
    }
    std::nth_element(qb.begin(), qb.begin() + long(qb.size() / 2), qb.end());
    const double floor = env("FLOOR", 0.1) * qb[qb.size() / 2];
    for (std::size_t v = 0; v < offset.size(); ++v)
      anchor[v] = mu * (anchor[v] + floor) / (1 + q[v] / 4);
    options.anchor = anchor;
    solution = solve(mesh_, topology_, shape_, equations, options);
    displace(mesh_, topology_, shape_, solution.displacement);
    std::vector<float> moved;
    for (std::size_t v = 0; v < solution.displacement.size(); ++v)
      if (solution.measured[v]) moved.push_back(std::abs(solution.displacement[v]));
    std::nth_element(moved.begin(), moved.begin() + long(moved.size() / 2), moved.end());
    log_info("factor {} residual {} n {} moved {} of {}", factor,
             std::sqrt(residuals.squared / double(residuals.count)), residuals.count,
             moved[moved.size() / 2], moved.size());
  }

  cv::Size size_of(std::size_t i) const {
    return {scaled_[i].camera.width, scaled_[i].camera.height};
  }

  static cv::Mat1f value(const Picture& p) {
    cv::Mat1f f;
    p.grey.convertTo(f, CV_32F);
    return f;
  }

  Picture picture(std::size_t i) const {
    Picture p = pictures_(i);
    if (p.grey.size() == size_of(i)) return p;
    cv::resize(p.grey, p.grey, size_of(i), 0, 0, cv::INTER_AREA);
    if (!p.mask.empty()) cv::resize(p.mask, p.mask, size_of(i), 0, 0, cv::INTER_NEAREST);
    return p;
  }

  Mesh& mesh_;
  std::span<const View> views_;
  const std::vector<std::vector<std::uint32_t>>& sources_;
  const Pictures& pictures_;
  const Options& options_;
  Topology topology_;
  std::vector<Eigen::Vector3f> start_;
  Shape shape_;
  std::optional<Visibility> visibility_;
  std::vector<View> scaled_;
  Report report_;
};

}  // namespace

Report refine(Mesh& mesh, std::span<const View> views,
              const std::vector<std::vector<std::uint32_t>>& sources, const Pictures& pictures,
              const Options& options, const ProgressSink&) {
  return Refiner(mesh, views, sources, pictures, options).run();
}

}  // namespace axial::refine
