// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/registration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/order_statistics.h"
#include "compare/height_map.h"
#include "geometry/icp.h"
#include "geometry/surface.h"

namespace axial::compare {
namespace {

constexpr int kSamplesOfPixel = 3, kCellsAlong = 20;
constexpr std::size_t kLeastSamples = 100;
constexpr int kLeastCells = 12;
constexpr double kLeastWeight = 1e-4;  // of a direction, relative to the best one

// A place where both surveys have a surface.
struct Sample {
  int y, x;                       // pixel of the coarse grid
  Eigen::Vector3d offset;         // of the later surface from the centre of the motion [m]
  Eigen::Vector2d before, after;  // slopes
  double weight;                  // 1 / (1 + slope^2)
  double difference;              // of heights, later minus earlier [m]
  bool used = true;

  double residual() const { return std::sqrt(weight) * difference; }
};

struct Samples {
  std::vector<Sample> all;
  double radius = 1;  // root mean square of the offsets [m]
  double sigma = 0;   // robust standard deviation of the residuals [m]
};

map::MapGrid coarse_grid(const map::MapGrid& grid, int longest_side) {
  const int longest = std::max(grid.columns, grid.rows);
  const int stride = std::max(1, (longest + longest_side - 1) / longest_side);
  return {grid.left, grid.top, grid.pixel * stride, std::max(1, grid.columns / stride),
          std::max(1, grid.rows / stride)};
}

// `base`: the height [map] above which the heights are stated.
Samples samples_of(const cv::Mat1f& before, const cv::Mat1f& after, const map::MapGrid& grid,
                   double base, const Eigen::Vector3d& centre) {
  Samples samples;
  double sum = 0;
  for (int y = 0; y < grid.rows; ++y)
    for (int x = 0; x < grid.columns; ++x) {
      const auto low = static_cast<double>(before(y, x)), high = static_cast<double>(after(y, x));
      if (std::isnan(low) || std::isnan(high)) continue;
      Sample sample{y,
                    x,
                    grid.centre(y, x, base + high) - centre,
                    slope_at(before, y, x, grid.pixel),
                    slope_at(after, y, x, grid.pixel),
                    1,
                    high - low};
      sample.weight = 1 / (1 + 0.25 * (sample.before + sample.after).squaredNorm());
      sum += sample.offset.squaredNorm();
      samples.all.push_back(sample);
    }
  samples.radius = std::sqrt(sum / std::max<double>(1, static_cast<double>(samples.all.size())));
  return samples;
}

// Leaves out the samples whose residual is an outlier, and their neighbours: a neighbour of changed
// ground may have changed in part.
void leave_out(Samples& samples, const map::MapGrid& grid, double outlier) {
  std::vector<double> residuals;
  for (const Sample& sample : samples.all) residuals.push_back(sample.residual());
  const double median = upper_median(residuals);
  samples.sigma = robust_deviation(residuals);
  // Rounding of float heights is no outlier.
  const double limit = std::max(outlier * samples.sigma, 1e-5 * grid.pixel);
  cv::Mat1b wrong(grid.rows + 2, grid.columns + 2, std::uint8_t{0});  // with a border
  for (const Sample& sample : samples.all)
    if (std::abs(sample.residual() - median) > limit)
      wrong(cv::Rect(sample.x, sample.y, 3, 3)).setTo(std::uint8_t{1});
  for (Sample& sample : samples.all) sample.used = wrong(sample.y + 1, sample.x + 1) == 0;
}

Vector6d scaled_row(const Sample& sample, const Eigen::Vector2d& slope, double radius) {
  return height_row(sample.offset, slope)
      .cwiseProduct((Vector6d() << Eigen::Vector3d::Constant(1 / radius), 1, 1, 1).finished());
}

struct Step {
  Vector6d change = Vector6d::Zero();  // rotation vector [rad], translation [m]
  Matrix6d covariance = Matrix6d::Zero();
  int determined = 0;
  double squared_length = 0;  // of the change, in standard deviations
};

struct System {
  Matrix6d normal = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  Matrix6d scatter = Matrix6d::Zero();  // of the cells' parts of `right`
};

System system_of(const Samples& samples, const map::MapGrid& grid) {
  const int side = std::max(2, (std::max(grid.columns, grid.rows) + kCellsAlong - 1) / kCellsAlong);
  const int cells_along = grid.columns / side + 1;
  std::vector<Vector6d> cells(static_cast<std::size_t>(cells_along * (grid.rows / side + 1)),
                              Vector6d::Zero());
  System system;
  std::size_t used = 0;
  for (const Sample& sample : samples.all) {
    if (!sample.used) continue;
    const Vector6d a = scaled_row(sample, sample.before, samples.radius);
    const Vector6d b = scaled_row(sample, sample.after, samples.radius);
    system.normal += 0.5 * sample.weight * (a * b.transpose() + b * a.transpose());
    cells[static_cast<std::size_t>(sample.y / side * cells_along + sample.x / side)] -=
        0.5 * sample.weight * sample.difference * (a + b);
    ++used;
  }
  int filled = 0;
  for (const Vector6d& cell : cells) {
    system.right += cell;
    system.scatter += cell * cell.transpose();
    filled += cell.isZero(0) ? 0 : 1;
  }
  if (used < kLeastSamples)
    fail("the surveys have only {} places in common to align by, and {} are needed", used,
         kLeastSamples);
  // Identical surveys have no residuals, and so no filled cells.
  if (filled > 0 && filled < kLeastCells)
    fail("the surveys have only {} parts of the map in common to align by, and {} are needed",
         filled, kLeastCells);
  if (filled > 6) system.scatter *= filled / (filled - 6.0);
  return system;
}

Step solve(const Samples& samples, const map::MapGrid& grid) {
  const System system = system_of(samples, grid);
  const EigenPairs eigen = symmetric_eigen(system.normal);
  Matrix6d inverse = Matrix6d::Zero();
  Step step;
  for (int k = 0; k < 6; ++k) {
    if (!(eigen.values[k] > kLeastWeight * eigen.values[5])) continue;
    const Vector6d direction = eigen.vectors.col(k);
    inverse += direction * direction.transpose() / eigen.values[k];
    ++step.determined;
    const double along = direction.dot(system.right);
    const double variance = direction.dot(system.scatter * direction);
    if (along != 0) step.squared_length += along * along / variance;
  }
  const Vector6d scale =
      (Vector6d() << Eigen::Vector3d::Constant(1 / samples.radius), 1, 1, 1).finished();
  step.change = scale.cwiseProduct(inverse * system.right);
  step.covariance = scale.asDiagonal() * (inverse * system.scatter * inverse) * scale.asDiagonal();
  return step;
}

// The vertices of `mesh` that are over the grid.
std::vector<Eigen::Vector3f> vertices_over(const Mesh& mesh, const map::MapFrame& frame,
                                           const map::MapGrid& grid) {
  std::vector<Eigen::Vector3f> vertices;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d at = frame.to_map(vertex.cast<double>());
    const double column = (at.x() - grid.left) / grid.pixel, row = (grid.top - at.y()) / grid.pixel;
    if (column >= 0 && column <= grid.columns && row >= 0 && row <= grid.rows)
      vertices.push_back(vertex);
  }
  return vertices;
}

// The motion that brings the vertices of `after` near to the surface of `before`.
RigidMotion first_motion(const Mesh& before, const Mesh& after, const map::MapFrame& frame,
                         const map::MapGrid& grid) {
  const std::vector<Eigen::Vector3f> points = vertices_over(after, frame, grid);
  if (points.size() < kLeastSamples)
    fail(
        "the later survey has only {} vertices over the earlier one to align by, and {} are needed",
        points.size(), kLeastSamples);
  const Similarity found =
      geometry::refine_rigid(points, geometry::Surface(before), {.samples = 5000, .stop = 1e-4})
          .transform;
  return {frame.axes * found.rotation * frame.axes.transpose(), frame.axes * found.translation,
          frame.origin};
}

// The same motion about another centre.
RigidMotion about(const Eigen::Vector3d& centre, const RigidMotion& motion) {
  return {motion.rotation,
          motion.rotation * (centre - motion.centre) + motion.centre + motion.translation - centre,
          centre};
}

void apply(const Vector6d& change, RigidMotion& motion) {
  const Eigen::Vector3d turn = change.head<3>();
  const Eigen::Matrix3d rotation =
      turn.norm() > 0 ? Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix()
                      : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  motion.rotation = rotation * motion.rotation;
  motion.translation = rotation * motion.translation + change.tail<3>();
}

// The mean of the places where both have a surface.
Eigen::Vector3d centre_of(const Samples& samples) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Sample& sample : samples.all) sum += sample.offset;
  return sum / std::max<double>(1, static_cast<double>(samples.all.size()));
}

double share_used(const Samples& samples) {
  const auto used = std::ranges::count_if(samples.all, [](const Sample& s) { return s.used; });
  return static_cast<double>(used) / static_cast<double>(samples.all.size());
}

// The second part of the registration.
class Refinement {
 public:
  Refinement(const Mesh& before, const Mesh& after, const map::MapFrame& frame,
             const map::MapGrid& grid, const RegistrationOptions& options,
             const ProgressSink& progress)
      : after_(after),
        frame_(frame),
        grid_(coarse_grid(grid, options.longest_side)),
        options_(options),
        progress_(progress),
        earlier_(height_map(before, frame, grid_, frame.origin.z(), kSamplesOfPixel)) {}

  Registration from(const RigidMotion& start) const {
    constexpr double kStop = 0.01;  // squared length of a step, in standard deviations
    Registration result;
    result.motion = about(start.centre + centre_of(samples_at(start)), start);
    for (;;) {
      Samples samples = samples_at(result.motion);
      leave_out(samples, grid_, options_.outlier);
      const Step step = solve(samples, grid_);
      result.covariance = step.covariance;
      result.determined = step.determined;
      result.share_used = share_used(samples);
      result.residual_sigma = samples.sigma;
      const double length =
          step.change.head<3>().norm() * samples.radius + step.change.tail<3>().norm();
      result.converged = step.squared_length < kStop || length < 1e-6 * grid_.pixel;
      const bool last = result.converged || result.iterations == options_.max_iterations;
      report(result.iterations + 1, last ? result.iterations + 1 : options_.max_iterations + 1);
      if (last) return result;
      apply(step.change, result.motion);
      ++result.iterations;
    }
  }

 private:
  void report(int done, int total) const {
    if (progress_) progress_(static_cast<std::size_t>(done), static_cast<std::size_t>(total));
  }

  Samples samples_at(const RigidMotion& motion) const {
    const double base = frame_.origin.z();
    const cv::Mat1f later = height_map(after_, moved(frame_, motion), grid_, base, kSamplesOfPixel);
    return samples_of(earlier_, later, grid_, base, motion.centre);
  }

  const Mesh& after_;
  const map::MapFrame& frame_;
  map::MapGrid grid_;
  const RegistrationOptions& options_;
  const ProgressSink& progress_;
  cv::Mat1f earlier_;
};

}  // namespace

map::MapFrame moved(const map::MapFrame& frame, const RigidMotion& motion) {
  return {motion.rotation * frame.axes,
          motion.rotation * (frame.origin - motion.centre) + motion.centre + motion.translation};
}

Similarity in_world(const RigidMotion& motion, const map::WorldAxes& map) {
  Similarity result;
  result.rotation = map.axes.transpose() * motion.rotation * map.axes;
  // From the origin of the world, whose place on the map is the offset.
  const Eigen::Vector3d origin = map.offset - motion.centre;
  result.translation =
      map.axes.transpose() * (motion.rotation * origin - origin + motion.translation);
  return result;
}

Vector6d height_row(const Eigen::Vector3d& offset, const Eigen::Vector2d& slope) {
  const Eigen::Vector3d normal(-slope.x(), -slope.y(), 1);
  return (Vector6d() << offset.cross(normal), normal).finished();
}

double Registration::height_variance(const Eigen::Vector3d& place,
                                     const Eigen::Vector2d& slope) const {
  const Vector6d row = height_row(place - motion.centre, slope);
  return row.dot(covariance * row);
}

Registration register_surveys(const Mesh& before, const Mesh& after, const map::MapFrame& frame,
                              const map::MapGrid& grid, const RegistrationOptions& options,
                              const ProgressSink& progress) {
  const Refinement refinement(before, after, frame, grid, options, progress);
  const Registration result = refinement.from(first_motion(before, after, frame, grid));
  return result.determined == 6 ? result : refinement.from({});
}

}  // namespace axial::compare
