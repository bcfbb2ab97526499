// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/visibility.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "geometry/posed_camera.h"
#include "geometry/surface.h"
#include "scene/any_camera.h"

namespace axial::compare {
namespace {

class Sights {
 public:
  Sights(const SeenSurvey& survey, double slack)
      : survey_(survey), slack_(slack), surface_(survey.mesh) {
    for (const geometry::PosedCamera& photo : survey.photos)
      cameras_.emplace_back(make_camera<double>(photo.camera));
  }

  // True if at least `least` photographs see the point [map].
  bool seen(const Eigen::Vector3d& place, int least) const {
    const Eigen::Vector3d point = survey_.frame.axes.transpose() * (place - survey_.frame.origin);
    int found = 0;
    for (std::size_t v = 0; v < cameras_.size() && found < least; ++v)
      found += sees(v, point) ? 1 : 0;
    return found >= least;
  }

 private:
  bool sees(std::size_t v, const Eigen::Vector3d& point) const {
    const geometry::PosedCamera& photo = survey_.photos[v];
    Eigen::Vector3d origin;  // the path of light is straight from here to the point
    const auto image = cameras_[v].project(photo.pose.to_camera(point), nullptr, &origin);
    if (!image.visible || !geometry::is_in_image(photo.camera, image.pixel, 1)) return false;
    const Eigen::Vector3d from = photo.pose.to_world(origin);
    return !surface_.between(from, point, 0, std::min(1.0, slack_ / (point - from).norm()));
  }

  const SeenSurvey& survey_;
  double slack_;
  geometry::Surface surface_;
  std::vector<AnyCamera<double>> cameras_;
};

}  // namespace

void mark_unseen(const SeenSurvey& survey, const map::MapGrid& grid, double base,
                 const cv::Mat1f& own, const cv::Mat1f& other, int least, double slack,
                 const ProgressSink& progress, cv::Mat1b& unseen) {
  const Sights sights(survey, slack);
  ProgressCounter counter(progress, static_cast<std::size_t>(grid.rows));
  parallel_for(static_cast<std::size_t>(grid.rows), [&](std::size_t row) {
    const auto y = static_cast<int>(row);
    for (int x = 0; x < grid.columns; ++x) {
      const float height = own(y, x), beside = other(y, x);
      if (unseen(y, x) > 0 || std::isnan(height) || std::isnan(beside)) continue;
      const auto seen = [&](float at) {
        return sights.seen(grid.centre(y, x, base + static_cast<double>(at)), least);
      };
      if (!seen(height) || (beside > height && !seen(beside))) unseen(y, x) = 255;
    }
    counter.add();
  });
}

}  // namespace axial::compare
