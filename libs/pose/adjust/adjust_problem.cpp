// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/adjust_problem.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/error.h"
#include "pose/bundle/free_motions.h"

namespace axial::pose {
namespace {

// The residuals of known numbers, in standard deviations.

struct LengthResidual {
  int offset;  // of the position within its block
  double metres, sigma;

  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    using std::sqrt;
    T sum(0);
    for (int k = offset; k < offset + 3; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    residual[0] = (sqrt(sum) - metres) / sigma;
    return true;
  }
};

struct PositionResidual {
  Eigen::Vector3d metres, sigma;

  template <class T>
  bool operator()(const T* pose, T* residual) const {
    for (int k = 0; k < 3; ++k) residual[k] = (pose[3 + k] - metres(k)) / sigma(k);
    return true;
  }
};

// Coordinates that are not known have infinite standard deviations, and thus no residual.
struct PlaceResidual {
  int offset;  // of the place within its block
  Eigen::Vector3d metres, sigma;

  template <class T>
  bool operator()(const T* block, T* residual) const {
    for (int k = 0; k < 3; ++k) residual[k] = (block[offset + k] - metres(k)) / sigma(k);
    return true;
  }
};

// How far a pose follows a motion of the whole model.
struct MotionResidual {
  PoseNumbers start;
  Eigen::Matrix<double, kPoseNumbers, 1> direction;

  template <class T>
  bool operator()(const T* pose, T* residual) const {
    residual[0] = T(0);
    for (int k = 0; k < kPoseNumbers; ++k)
      residual[0] += direction(k) * (pose[k] - start[static_cast<std::size_t>(k)]);
    return true;
  }
};

struct MeasuredResidual {
  int number;
  double sigma;

  template <class T>
  bool operator()(const T* change, T* residual) const {
    residual[0] = change[number] / sigma;
    return true;
  }
};

// The least possible change of a number of the port; nothing if there is none.
std::optional<double> least_value(const refractive::Port<double>& port, int number) {
  constexpr int kDistance = 2;
  const auto* const flat = std::get_if<refractive::FlatPort<double>>(&port);
  if (flat && number == kDistance) return -flat->distance;
  if (number != kIndexNumber) return {};
  return std::visit([](const auto& kind) { return kind.n_air - kind.n_water; }, port);
}

ceres::Problem::Options problem_options(CurrentCameras* cameras) {
  ceres::Problem::Options options;
  options.evaluation_callback = cameras;
  return options;
}

// A position that is farther from the camera than this counts linearly [standard deviations]. Only
// 3 % of correct positions are.
constexpr double kPositionLoss = 3;
// Of excluded motions [rad, m]. The cost does not depend on these motions, so that the residual is
// 0 in the end, whatever its standard deviation.
constexpr double kMotionSigma = 1e-4;

void check(const Bundle& bundle, const AdjustOptions& options) {
  if (bundle.observations.empty()) fail("bundle adjustment: no observations");
  if (!(options.pixel_sigma > 0)) fail("bundle adjustment: pixel_sigma must be positive");
  for (const KnownDistance& known : options.distances)
    if (!(known.metres > 0) || !(known.sigma > 0))
      fail("bundle adjustment: the known distance is {} +- {} m: both values must be positive",
           known.metres, known.sigma);
  for (const KnownPosition& known : options.positions)
    if (!(known.sigma.array() > 0).all())
      fail(
          "bundle adjustment: the standard deviation of a known position is {} m: must be positive",
          known.sigma.minCoeff());
  for (const KnownPlace& known : options.places)
    if (!(known.sigma.array() > 0).all())
      fail("bundle adjustment: the standard deviation of {} is {} m: must be positive", known.name,
           known.sigma.minCoeff());
  for (const BundleCamera& camera : bundle.cameras) {
    const auto& free = options.unknowns(camera).free;
    const auto end = free.begin() + kFocalNumber;
    if (!camera.measured.port && std::find(free.begin(), end, true) != end)
      fail("bundle adjustment: a camera in air has no port to adjust");
  }
}

}  // namespace

AdjustProblem::AdjustProblem(const Bundle& bundle, const AdjustOptions& options)
    : bundle_(bundle), options_(options) {
  check(bundle, options);
  fill_numbers();
  for (const BundlePoint& point : bundle.points) tied_.push_back(point.is_target);
  cameras_ = std::make_unique<CurrentCameras>(bundle.cameras, change_block(0));
  problem_ = std::make_unique<ceres::Problem>(problem_options(cameras_.get()));
  add_observations();
  add_known();
  add_rigs();
  fix_what_stays();
}

void AdjustProblem::fill_numbers() {
  numbers_.resize(kPoseNumbers * bundle_.images.size() + kHousingNumbers * bundle_.cameras.size() +
                  3 * bundle_.points.size() + kPoseNumbers * rig_camera_count());
  fill_rigs();
  for (std::size_t i = 0; i < bundle_.images.size(); ++i)
    std::ranges::copy(numbers_of(bundle_.images[i].pose), image_block(i));
  for (std::size_t i = 0; i < bundle_.cameras.size(); ++i)
    if (owns_change(i)) std::ranges::copy(bundle_.cameras[i].change, change_block(i));
  for (std::size_t i = 0; i < bundle_.points.size(); ++i)
    std::ranges::copy(bundle_.points[i].position, point_block(i));
}

void AdjustProblem::add_observations() {
  std::map<double, ceres::LossFunction*> losses;  // few: features are weighed in classes
  const auto loss_of = [&](double sigma) {
    ceres::LossFunction*& loss = losses[sigma];
    if (!loss)
      loss = new ceres::ScaledLoss(new ceres::HuberLoss(options_.loss_sigmas * sigma),
                                   1 / (sigma * sigma), ceres::TAKE_OWNERSHIP);
    return loss;
  };
  for (const Observation& observation : bundle_.observations) {
    const BundleImage& image = bundle_.images[observation.image];
    problem_->AddResidualBlock(
        new ObservationCost(observation, image.pose, bundle_.cameras[image.camera],
                            (*cameras_)[image.camera]),
        loss_of(options_.sigma_of(observation)), image_block(observation.image),
        point_block(observation.point), change_block(image.camera));
  }
}

void AdjustProblem::add_known() {
  for (const KnownDistance& known : options_.distances) add_known_distance(known);
  add_known_positions();
  if (!options_.places.empty()) {
    auto* const loss = new ceres::HuberLoss(kPositionLoss);
    for (const KnownPlace& known : options_.places) add_known_place(known, loss);
  }
  for (std::size_t camera = 0; camera < bundle_.cameras.size(); ++camera) {
    if (!owns_change(camera)) continue;
    const Unknowns& unknowns = options_.unknowns(bundle_.cameras[camera]);
    for (int k = 0; k < kHousingNumbers; ++k)
      if (unknowns.free[static_cast<std::size_t>(k)]) add_measured(camera, k);
  }
}

void AdjustProblem::add_measured(std::size_t camera, int number) {
  const double sigma = options_.sigma_before(bundle_.cameras[camera], number);
  if (!(sigma > 0 && std::isfinite(sigma))) return;
  problem_->AddResidualBlock(new ceres::AutoDiffCostFunction<MeasuredResidual, 1, kHousingNumbers>(
                                 new MeasuredResidual{number, sigma}),
                             nullptr, change_block(camera));
  const auto& port = bundle_.cameras[camera].measured.port;
  if (!port) return;
  if (const std::optional<double> least = least_value(*port, number))
    problem_->SetParameterLowerBound(change_block(camera), number, *least);
}

void AdjustProblem::add_known_positions() {
  if (options_.positions.empty()) return;
  auto* loss = new ceres::HuberLoss(kPositionLoss);
  for (const KnownPosition& known : options_.positions)
    problem_->AddResidualBlock(new ceres::AutoDiffCostFunction<PositionResidual, 3, kPoseNumbers>(
                                   new PositionResidual{known.metres, known.sigma}),
                               loss, image_block(known.image));
}

void AdjustProblem::add_known_place(const KnownPlace& known, ceres::LossFunction* loss) {
  if (known.of == KnownDistance::Between::images) {
    problem_->AddResidualBlock(new ceres::AutoDiffCostFunction<PlaceResidual, 3, kPoseNumbers>(
                                   new PlaceResidual{3, known.metres, known.sigma}),
                               loss, image_block(known.index));
    return;
  }
  const std::size_t point = point_of(bundle_, known.index);
  problem_->AddResidualBlock(new ceres::AutoDiffCostFunction<PlaceResidual, 3, 3>(
                                 new PlaceResidual{0, known.metres, known.sigma}),
                             loss, point_block(point));
}

void AdjustProblem::exclude_free_motions() {
  const std::size_t image = anchor();
  const Pose& pose = bundle_.images[image].pose;
  for (const Motion& motion : free_motions(bundle_, options_)) {
    MotionResidual residual{numbers_of(pose), {}};
    residual.direction << -(pose.rotation * motion.rotation), motion.shift_of(pose.centre);
    residual.direction /= kMotionSigma * residual.direction.norm();
    problem_->AddResidualBlock(new ceres::AutoDiffCostFunction<MotionResidual, 1, kPoseNumbers>(
                                   new MotionResidual(residual)),
                               nullptr, image_block(image));
  }
}

void AdjustProblem::add_known_distance(const KnownDistance& known) {
  ceres::LossFunction* const loss =
      known.name.empty() ? nullptr : new ceres::HuberLoss(kPositionLoss);
  if (known.between == KnownDistance::Between::images) {
    problem_->AddResidualBlock(
        new ceres::AutoDiffCostFunction<LengthResidual, 1, kPoseNumbers, kPoseNumbers>(
            new LengthResidual{3, known.metres, known.sigma}),
        loss, image_block(known.first), image_block(known.second));
    return;
  }
  const std::size_t first = point_of(bundle_, known.first);
  const std::size_t second = point_of(bundle_, known.second);
  tied_[first] = tied_[second] = true;
  problem_->AddResidualBlock(new ceres::AutoDiffCostFunction<LengthResidual, 1, 3, 3>(
                                 new LengthResidual{0, known.metres, known.sigma}),
                             loss, point_block(first), point_block(second));
}

std::size_t AdjustProblem::anchor() const {
  for (std::size_t i = 0; i < bundle_.images.size(); ++i)
    if (is_observed(i)) return i;
  return 0;
}

void AdjustProblem::fix_points() {
  for (std::size_t i = 0; i < bundle_.points.size(); ++i)
    if (problem_->HasParameterBlock(point_block(i)))
      problem_->SetParameterBlockConstant(point_block(i));
}

void AdjustProblem::fix_poses() {
  for (std::size_t i = 0; i < bundle_.images.size(); ++i)
    if (is_observed(i)) problem_->SetParameterBlockConstant(image_block(i));
}

void AdjustProblem::fix_what_stays() {
  if (options_.points_known) fix_points();
  if (options_.poses_known) fix_poses();
  if (!options_.points_known && !options_.poses_known && !options_.places.empty())
    exclude_free_motions();
  const bool held = options_.points_known || options_.poses_known || !options_.places.empty();
  if (!held && options_.positions.size() < 3)
    problem_->SetParameterBlockConstant(image_block(anchor()));
  for (std::size_t camera = 0; camera < bundle_.cameras.size(); ++camera) {
    if (!owns_change(camera)) continue;
    const Unknowns& unknowns = options_.unknowns(bundle_.cameras[camera]);
    std::vector<int> fixed;
    for (int k = 0; k < kHousingNumbers; ++k)
      if (const auto number = static_cast<std::size_t>(k);
          !unknowns.free[number] || options_.keeps(camera, number))
        fixed.push_back(k);
    double* const change = change_block(camera);
    if (!problem_->HasParameterBlock(change) || fixed.empty()) continue;
    if (fixed.size() == kHousingNumbers)
      problem_->SetParameterBlockConstant(change);
    else
      problem_->SetManifold(change, new ceres::SubsetManifold(kHousingNumbers, fixed));
  }
}

std::vector<double*> AdjustProblem::camera_blocks() {
  std::vector<double*> blocks;
  const auto add = [&](double* block) {
    if (problem_->HasParameterBlock(block) && !problem_->IsParameterBlockConstant(block))
      blocks.push_back(block);
  };
  for (std::size_t i = 0; i < bundle_.images.size(); ++i) add(image_block(i));
  for (std::size_t i = 0; i < bundle_.cameras.size(); ++i)
    if (owns_change(i)) add(change_block(i));
  for (std::size_t i = 0; i < bundle_.rigs.size(); ++i)
    for (std::size_t k = 0; k < bundle_.rigs[i].cameras.size(); ++k) add(rig_block(i, k));
  for (std::size_t i = 0; i < bundle_.points.size(); ++i)
    if (tied_[i]) add(point_block(i));
  return blocks;
}

std::size_t AdjustProblem::pose_count() {
  std::size_t count = 0;
  for (std::size_t i = 0; i < bundle_.images.size(); ++i)
    count += is_observed(i) && !problem_->IsParameterBlockConstant(image_block(i)) ? 1 : 0;
  return count;
}

std::vector<double*> AdjustProblem::point_blocks() {
  std::vector<double*> blocks;
  if (options_.points_known) return blocks;
  for (std::size_t i = 0; i < bundle_.points.size(); ++i)
    if (!tied_[i] && problem_->HasParameterBlock(point_block(i))) blocks.push_back(point_block(i));
  return blocks;
}

void AdjustProblem::write_back(Bundle& bundle) {
  for (std::size_t i = 0; i < bundle.images.size(); ++i) {
    PoseNumbers pose;
    std::copy_n(image_block(i), kPoseNumbers, pose.begin());
    bundle.images[i].pose = pose_with(bundle_.images[i].pose, pose);
  }
  for (std::size_t i = 0; i < bundle.points.size(); ++i)
    std::copy_n(point_block(i), 3, bundle.points[i].position.begin());
  for (std::size_t i = 0; i < bundle.cameras.size(); ++i)
    std::copy_n(change_block(i), kHousingNumbers, bundle.cameras[i].change.begin());
  write_rigs(bundle);
}

}  // namespace axial::pose
