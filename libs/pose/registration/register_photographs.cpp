// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/registration/register_photographs.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/hash.h"
#include "base/parallel.h"
#include "pose/adjust/adjust.h"
#include "pose/adjust/uncertainty.h"

namespace axial::pose {
namespace {

// What is known about an image.
struct State {
  bool posed = false;
  bool fresh = false;         // it had no pose at the start
  std::size_t sightings = 0;  // at the last attempt to find a pose
  int poses = 0;              // that it has got
  std::string why_not = {};   // the reason why it has no pose
};

class Registration {
 public:
  Registration(Bundle& bundle, const FeatureMatches& matches, const RegisterOptions& options)
      : bundle_(bundle), matches_(matches), options_(options) {
    for (const std::size_t seen : observations_by_image(bundle))
      states_.push_back({.posed = seen > 0, .fresh = seen == 0});
    search_.max_error = options.tracks.max_error;
    search_.distance = median_distance(bundle);
    limits_ = options.place;
    limits_.least_sightings = options.tracks.min_observations;
  }

  RegisterReport run(const Context& context);

 private:
  std::size_t place_images();
  void try_to_place(std::size_t image, const std::vector<std::vector<std::size_t>>& points);
  void complete();
  std::string adjust_all();
  std::size_t posed_count() const {
    return static_cast<std::size_t>(std::ranges::count(states_, true, &State::posed));
  }
  RegisterReport report() const;

  Bundle& bundle_;
  const FeatureMatches& matches_;
  const RegisterOptions& options_;
  AbsolutePoseOptions search_;
  PlaceLimits limits_;
  std::vector<State> states_;  // by image
  CompletedTracks added_;
};

void Registration::try_to_place(std::size_t image,
                                const std::vector<std::vector<std::size_t>>& points) {
  State& state = states_[image];
  const std::vector<Sighting> sightings = sightings_of(image, bundle_, matches_, points);
  // The same sightings would fail again.
  if (!state.why_not.empty() && sightings.size() == state.sightings) return;
  state.sightings = sightings.size();
  AbsolutePoseOptions search = search_;
  search.seed = image;
  BundleImage& placed = bundle_.images[image];
  const Place place = place_of(bundle_.cameras[placed.camera], sightings, search, limits_);
  state.why_not = place.why_not;
  if (!place.why_not.empty()) return;
  placed.pose = place.pose;
  state.posed = true;
  ++state.poses;
}

// Gives poses to all images that can get one now. Returns their number.
std::size_t Registration::place_images() {
  const std::size_t before = posed_count();
  const auto points = points_of_features(bundle_, matches_);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < states_.size(); ++i)
    if (!states_[i].posed && states_[i].poses < options_.attempts) open.push_back(i);
  parallel_for(open.size(), [&](std::size_t i) { try_to_place(open[i], points); });
  return posed_count() - before;
}

void Registration::complete() {
  ImagesWithPoses images;
  images.last_source = options_.last_source;
  for (const State& state : states_) {
    images.posed.push_back(state.posed);
    images.fresh.push_back(state.fresh);
  }
  const CompletedTracks added = complete_tracks(bundle_, matches_, images, options_.tracks);
  added_.observations += added.observations;
  added_.points += added.points;
}

// Returns a line about the result.
std::string Registration::adjust_all() {
  AdjustOptions adjusting = options_.adjust;
  adjusting.pixel_sigma = observed_pixel_sigma(bundle_, adjusting);
  const AdjustReport adjusted = adjust(bundle_, adjusting);
  const std::size_t dropped = filter(bundle_, options_.tracks);
  const std::vector<std::size_t> seen = observations_by_image(bundle_);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!states_[i].posed || seen[i] > 0) continue;
    states_[i].posed = false;
    states_[i].why_not =
        fmt::format("its pose did not last: after adjustment, fewer than {} observations fit",
                    options_.tracks.min_observations);
    states_[i].sightings = 0;
  }
  return fmt::format(
      "{} photographs have poses: {} iterations, RMS {:.3f} px, {} observations "
      "dropped",
      posed_count(), adjusted.iterations, root_mean_square(reprojection_errors(bundle_)), dropped);
}

RegisterReport Registration::report() const {
  RegisterReport report;
  report.added = added_;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (states_[i].fresh && states_[i].posed) report.registered.push_back(i);
    if (!states_[i].posed) report.left_out.push_back({i, states_[i].why_not});
  }
  return report;
}

RegisterReport Registration::run(const Context& context) {
  complete();
  std::size_t grown = 0;  // images since the last adjustment
  while (true) {
    const std::size_t placed = place_images();
    if (placed == 0 && grown == 0) break;
    if (placed > 0) complete();
    grown += placed;
    if (placed > 0 && grown * 10 < posed_count()) continue;
    context.info("{}", adjust_all());
    context.check_stop();
    grown = 0;
  }
  complete();
  return report();
}

}  // namespace

RegisterReport register_photographs(Bundle& bundle, const FeatureMatches& matches,
                                    const RegisterOptions& options, const Context& context) {
  return Registration(bundle, matches, options).run(context);
}

}  // namespace axial::pose
