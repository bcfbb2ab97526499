// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/import_check.h"

#include <map>

#include "base/error.h"
#include "diagnosis/port_check.h"
#include "diagnosis/track_pictures.h"
#include "diagnosis/track_sample.h"
#include "diagnosis/words.h"
#include "pose/bundle/tracks.h"
#include "pose/colmap_bundle.h"

namespace axial::diagnosis {
namespace {

// Patches of the same place correlate by 0.6 or more unless noise or haze hides the texture;
// patches of different places correlate by 0.2 or less.
constexpr double kAgree = 0.5, kClearlyMore = 0.25;
// A single change may find the cause without its exact value: the optical axis is tried for a
// normal that is in truth some degrees off it.
constexpr double kAgreeWithChange = 0.35;
// Below the correlation of any match that a feature detector makes.
constexpr double kNothingInCommon = 0.1;

// `in_air` behind the ports of `housing`. A water surface is another port for each pose.
pose::Bundle behind_ports(const pose::Bundle& in_air, const io::ColmapModel& sample,
                          const io::Housing& housing) {
  pose::Bundle bundle = in_air;
  bundle.cameras.clear();
  std::map<std::pair<std::size_t, std::string>, std::size_t> places;
  for (std::size_t i = 0; i < bundle.images.size(); ++i) {
    pose::BundleImage& image = bundle.images[i];
    const std::string& name = housing.port_of(image.name, sample.images[i].camera);
    const auto found = housing.ports.find(name);
    const bool surface =
        found != housing.ports.end() && std::holds_alternative<WaterSurface>(found->second);
    const auto [place, added] =
        places.try_emplace({image.camera, surface ? image.name : name}, bundle.cameras.size());
    if (added || surface) {
      place->second = bundle.cameras.size();
      bundle.cameras.push_back(in_air.cameras[image.camera]);
      bundle.cameras.back().measured.port = housing.port_at(name, image.pose, image.name);
    }
    image.camera = place->second;
  }
  return bundle;
}

std::vector<double> claimed_errors(const io::ColmapModel& sample) {
  std::vector<double> errors;
  for (const io::ColmapPoint3D& point : sample.points) errors.push_back(point.error);
  return errors;
}

// The change with which the photographs agree clearly better than with the given cameras; the first
// of several.
std::optional<ChangeByPictures> change_by_pictures(const TrackPictures& pictures,
                                                   const pose::Bundle& bundle, double given,
                                                   const Context& context) {
  std::optional<ChangeByPictures> best;
  for (const PortChange& change : likely_changes(bundle)) {
    if (change.of == PortChange::Of::port_left_out || change.of == PortChange::Of::focal_in_air)
      continue;
    const auto value = pictures.behind(changed(bundle, change));
    if (value) context.details("Photographs: {:.2f} with {}", *value, change.cause);
    if (value && *value > kAgreeWithChange && *value > given + kClearlyMore &&
        (!best || *value > best->agreement + 0.02))
      best = ChangeByPictures{change, *value};
  }
  return best;
}

// For tracks that fit cameras in air. They come from photographs in air, or their poses were
// computed without the port. The photographs tell which.
std::optional<std::string> by_pictures(const PortCheck& check, const io::ColmapModel& sample,
                                       const pose::Bundle& in_air, const pose::Bundle& bundle,
                                       bool ports, const std::filesystem::path& image_folder,
                                       const Context& context) {
  if (image_folder.empty()) return {};
  const TrackPictures pictures(sample, in_air, image_folder);
  const auto at_tracks = pictures.at_tracks();
  if (!at_tracks) return {};
  const auto agreement = pictures.behind(bundle);
  if (!agreement) return {};
  const double behind = *agreement;
  context.details("Photographs: {:.2f} at the tracks, {:.2f} where the cameras predict", *at_tracks,
                  behind);
  if (ports && !check.fits() && *at_tracks > kAgree && *at_tracks > behind + kClearlyMore)
    return text_without_port(check, *at_tracks, behind);
  if (*at_tracks > kAgree) return {};
  const double given = std::max(ports ? behind : *at_tracks, 0.0);
  const auto better = change_by_pictures(pictures, bundle, given, context);
  if (!better && (given >= kNothingInCommon || *at_tracks >= kNothingInCommon)) return {};
  return text_by_pictures(given, ports, better);
}

}  // namespace

std::optional<std::string> import_warning(const io::ColmapModel& model, const io::Housing& housing,
                                          const std::filesystem::path& image_folder,
                                          const Context& context) {
  try {
    const io::ColmapModel sample = sample_tracks(model);
    pose::Bundle in_air = pose::to_bundle(sample, sample.cameras, {}).bundle;
    triangulate(in_air);
    const pose::Bundle bundle = behind_ports(in_air, sample, housing);
    const PortCheck check = check_ports(bundle, claimed_errors(sample));
    context.details("Tracks: {} points, {} observations, {:.3f} px off, {:.3f} px in air",
                    check.points, check.observations, check.residual, check.in_air);
    if (!check.tells()) return {};
    const bool ports = std::ranges::any_of(bundle.cameras, [](const pose::BundleCamera& camera) {
      return camera.measured.port.has_value();
    });
    // A model with ports has tracks of photographs taken through these ports.
    const bool carried = std::ranges::any_of(
        sample.cameras, [](const io::ColmapCamera& camera) { return camera.port.has_value(); });
    if (check.fits_in_air() && !carried)
      return by_pictures(check, sample, in_air, bundle, ports, image_folder, context);
    if (check.fits()) return {};
    return text_of(check, ports);
  } catch (const Error&) {
    return {};  // an unsupported lens, or an image whose rays do not reach its port
  }
}

}  // namespace axial::diagnosis
