// SPDX-License-Identifier: GPL-3.0-or-later
#include "left_out.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "base/log.h"
#include "io/colmap/colmap_database.h"
#include "pose/colmap_bundle.h"
#include "pose/registration/register_photographs.h"
#include "scene/decompositions.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;
using io::ColmapModel;
using io::ColmapPoint2D;

constexpr Rgb kGrey{128, 128, 128};

// The model stores coordinates as COLMAP's text files do: equal to the database's up to rounding.
bool same_features(const std::vector<ColmapPoint2D>& a, const std::vector<ColmapPoint2D>& b) {
  constexpr double kRounding = 0.01;  // [px]
  return std::ranges::equal(a, b, [](const ColmapPoint2D& x, const ColmapPoint2D& y) {
    return std::abs(x.x - y.x) <= kRounding && std::abs(x.y - y.y) <= kRounding;
  });
}

using ImagesByName = std::map<std::string, const io::DatabaseImage*>;

// Takes the sizes of the features from the database. Error if the photographs are others.
void take_sizes(const fs::path& file, const ImagesByName& images, ColmapModel& model) {
  for (io::ColmapImage& image : model.images) {
    const auto found = images.find(image.name);
    if (found == images.end())
      fail("{}: has no photograph '{}' of the model: is it the database of this model?",
           file.string(), image.name);
    if (!same_features(image.points, found->second->features))
      fail("{}: the features of '{}' are not those of the model: is it the database of this model?",
           file.string(), image.name);
    for (std::size_t i = 0; i < image.points.size(); ++i)
      image.points[i].size = found->second->features[i].size;
  }
}

// Why photographs of the camera cannot be used; empty if they can.
std::string lens_problem(const io::ColmapCamera& camera, std::span<const io::ColmapCamera> lenses) {
  ColmapModel one;
  one.cameras = {camera};
  one.images.resize(1);
  one.images[0].camera = camera.id;
  try {
    pose::to_bundle(one, lenses, {});
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

// Adds photographs without poses to a model.
class Adder {
 public:
  Adder(const io::ColmapDatabase& database, std::span<const io::ColmapCamera> lenses,
        ColmapModel& model)
      : model_(model) {
    for (const io::ColmapImage& image : model.images) ids_.insert(image.id);
    for (const io::ColmapCamera& camera : model.cameras) cameras_.insert(camera.id);
    for (const io::ColmapCamera& camera : database.cameras)
      if (const std::string problem = lens_problem(camera, lenses); !problem.empty())
        problems_[camera.id] = problem;
      else
        usable_[camera.id] = &camera;
  }

  void add(const io::DatabaseImage& image, std::vector<Unregistered>& unusable) {
    if (problems_.contains(image.camera)) {
      unusable.push_back({image.name, problems_[image.camera]});
      return;
    }
    if (cameras_.insert(image.camera).second) model_.cameras.push_back(*usable_[image.camera]);
    io::ColmapImage added;
    added.id = ids_.contains(image.id) ? *ids_.rbegin() + 1 : image.id;
    added.camera = image.camera;
    added.name = image.name;
    added.points = image.features;
    ids_.insert(added.id);
    model_.images.push_back(std::move(added));
  }

 private:
  ColmapModel& model_;
  std::set<std::uint32_t> ids_, cameras_;
  std::map<std::uint32_t, std::string> problems_;
  std::map<std::uint32_t, const io::ColmapCamera*> usable_;
};

pose::FeatureMatches matches_of(const io::ColmapDatabase& database, const ColmapModel& model) {
  std::map<std::string, std::uint32_t> by_name;
  std::vector<std::vector<Eigen::Vector2d>> features;
  for (const io::ColmapImage& image : model.images) {
    by_name[image.name] = static_cast<std::uint32_t>(features.size());
    features.emplace_back();
    for (const ColmapPoint2D& point : image.points)
      features.back().emplace_back(point.x - 0.5, point.y - 0.5);
  }
  std::map<std::uint32_t, std::uint32_t> by_id;  // in the database
  for (const io::DatabaseImage& image : database.images)
    if (const auto found = by_name.find(image.name); found != by_name.end())
      by_id[image.id] = found->second;
  pose::FeatureMatches matches(std::move(features));
  for (const io::DatabasePair& pair : database.pairs) {
    const auto first = by_id.find(pair.first), second = by_id.find(pair.second);
    if (first == by_id.end() || second == by_id.end()) continue;
    for (const auto& match : pair.matches)
      matches.add(first->second, match[0], second->second, match[1]);
  }
  matches.sort();
  return matches;
}

// Writes the poses, points and observations of a bundle into the model from which it was made.
class ModelWriter {
 public:
  ModelWriter(ColmapModel& model, const pose::Bundle& bundle)
      : model_(model), bundle_(bundle), seen_(observations_by_image(bundle)) {}

  // Moves what the bundle does not have into its frame and unit.
  void move(std::size_t posed);
  void take_points();
  void take_observations();
  void drop_images_without_pose(std::size_t posed);

 private:
  void unlink(ColmapPoint2D& feature, std::uint32_t image, std::size_t index);

  ColmapModel& model_;
  const pose::Bundle& bundle_;
  const std::vector<std::size_t> seen_;              // observations by image
  std::map<std::uint64_t, std::size_t> place_ = {};  // of points in the model, by id
};

// `posed`: the number of images that had poses before.
void ModelWriter::move(std::size_t posed) {
  std::vector<std::size_t> common;
  for (std::size_t i = 0; i < posed; ++i)
    if (seen_[i] > 0) common.push_back(i);
  Eigen::Matrix3Xd from(3, common.size()), to(3, common.size());
  for (std::size_t k = 0; k < common.size(); ++k) {
    from.col(static_cast<Eigen::Index>(k)) = model_.images[common[k]].pose.centre;
    to.col(static_cast<Eigen::Index>(k)) = bundle_.images[common[k]].pose.centre;
  }
  const Similarity change = best_similarity(from, to);
  for (io::ColmapPoint3D& point : model_.points) point.position = change(point.position);
  for (std::size_t i = 0; i < model_.images.size(); ++i)
    model_.images[i].pose = seen_[i] > 0 ? bundle_.images[i].pose : change(model_.images[i].pose);
}

void ModelWriter::take_points() {
  for (std::size_t i = 0; i < model_.points.size(); ++i) place_[model_.points[i].id] = i;
  for (const pose::BundlePoint& point : bundle_.points) {
    const auto [found, added] = place_.try_emplace(point.source, model_.points.size());
    if (added) model_.points.push_back({point.source, point.position, kGrey, 0, {}});
    model_.points[found->second].position = point.position;
  }
}

// Takes the feature from the track of its point.
void ModelWriter::unlink(ColmapPoint2D& feature, std::uint32_t image, std::size_t index) {
  if (feature.point3d == io::kNoPoint3D) return;
  std::erase_if(model_.points[place_.at(feature.point3d)].track,
                [&](const io::ColmapTrackElement& element) {
                  return element.image == image && element.point2d == index;
                });
}

void ModelWriter::take_observations() {
  for (const pose::Observation& observation : bundle_.observations) {
    io::ColmapImage& image = model_.images[observation.image];
    ColmapPoint2D& feature = image.points[observation.source];
    const std::uint64_t point = bundle_.points[observation.point].source;
    if (feature.point3d == point) continue;
    unlink(feature, image.id, observation.source);
    feature.point3d = point;
    model_.points[place_.at(point)].track.push_back(
        {image.id, static_cast<std::uint32_t>(observation.source)});
  }
}

void ModelWriter::drop_images_without_pose(std::size_t posed) {
  std::size_t index = 0;
  std::erase_if(model_.images, [&](const io::ColmapImage&) {
    const std::size_t i = index++;
    return i >= posed && seen_[i] == 0;
  });
}

// Removes lengths whose ends have no observations.
void drop_unseen(std::vector<pose::KnownDistance>& distances, const pose::Bundle& bundle) {
  const std::vector<std::size_t> seen = observations_by_image(bundle);
  std::erase_if(distances, [&](const pose::KnownDistance& known) {
    return known.between == pose::KnownDistance::Between::images &&
           (seen[known.first] == 0 || seen[known.second] == 0);
  });
}

// Refines the bundle of COLMAP's poses. Known lengths that get lost are left out.
void refine_first(pose::Bundle& bundle, pose::RefineOptions& options, const Context& context) {
  drop_unseen(options.adjust.distances, bundle);
  const pose::Bundle start = bundle;
  while (true) {
    pose::bring_to_metres(bundle, options.adjust);
    if (pose::refine(bundle, options, context).lost.empty()) return;
    options.adjust.distances.clear();
    bundle = start;
  }
}

Registered named(const pose::RegisterReport& report, const LeftOutPhotographs& left_out,
                 const ColmapModel& model) {
  Registered registered;
  registered.observations = report.added.observations;
  registered.points = report.added.points;
  for (const std::size_t i : report.registered) registered.names.push_back(model.images[i].name);
  for (const pose::LeftOut& one : report.left_out)
    if (one.image >= left_out.first)
      registered.left_out.push_back({model.images[one.image].name, one.reason});
  registered.left_out.insert(registered.left_out.end(), left_out.unusable.begin(),
                             left_out.unusable.end());
  return registered;
}

}  // namespace

LeftOutPhotographs add_left_out(const fs::path& file, std::span<const io::ColmapCamera> lenses,
                                ColmapModel& model) {
  const io::ColmapDatabase database = io::read_colmap_database(file);
  ImagesByName images;
  for (const io::DatabaseImage& image : database.images) images[image.name] = &image;
  take_sizes(file, images, model);
  LeftOutPhotographs left_out;
  left_out.first = model.images.size();
  for (const io::ColmapImage& image : model.images) images.erase(image.name);
  Adder adder(database, lenses, model);
  for (const io::DatabaseImage& image : database.images)
    if (images.contains(image.name)) adder.add(image, left_out.unusable);
  left_out.matches = matches_of(database, model);
  return left_out;
}

Registered register_left_out(ColmapModel& model, const LeftOutPhotographs& left_out,
                             pose::Bundle bundle, pose::RefineOptions options,
                             const Context& context) {
  refine_first(bundle, options, context);
  pose::RegisterOptions registering;
  registering.adjust = options.adjust;
  registering.tracks = options.tracks;
  for (const io::ColmapPoint3D& point : model.points)
    registering.last_source = std::max<std::size_t>(registering.last_source, point.id);
  const pose::RegisterReport report =
      pose::register_photographs(bundle, left_out.matches, registering, context);
  Registered registered = named(report, left_out, model);
  ModelWriter writer(model, bundle);
  writer.move(left_out.first);
  writer.take_points();
  writer.take_observations();
  writer.drop_images_without_pose(left_out.first);
  return registered;
}

void log_registered(const Registered& registered) {
  const std::size_t count = registered.names.size();
  if (const std::size_t all = count + registered.left_out.size(); all > 0)
    log_info("Registered {} of {} photographs that COLMAP left out", count, all);
  log_info("Tracks have {} further observations and {} further points", registered.observations,
           registered.points);
  for (const Unregistered& one : registered.left_out)
    log_warning("{}: not registered: {}", one.name, one.reason);
}

}  // namespace axial::apps
