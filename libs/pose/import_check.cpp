// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/import_check.h"

#include <fmt/format.h>

#include <map>

#include "base/error.h"
#include "base/log.h"
#include "pose/colmap_bundle.h"
#include "pose/port_check.h"
#include "pose/track_pictures.h"
#include "pose/track_sample.h"
#include "pose/tracks.h"

namespace axial::pose {
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
Bundle behind_ports(const Bundle& in_air, const io::ColmapModel& sample,
                    const io::Housing& housing) {
  Bundle bundle = in_air;
  bundle.cameras.clear();
  std::map<std::pair<std::size_t, std::string>, std::size_t> places;
  for (std::size_t i = 0; i < bundle.images.size(); ++i) {
    BundleImage& image = bundle.images[i];
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

std::string misfit(const PortCheck& check, const Bundle& bundle, bool ports) {
  std::string line =
      ports
          ? fmt::format(
                "Port, lens, scale and poses do not fit together: the sparse points have errors of "
                "{:.2f} px behind the ports, {:.2f} px without them, where {:.2f} px are expected",
                check.residual, check.in_air, check.noise)
          : fmt::format(
                "Lens and poses do not fit together: the sparse points have errors of {:.2f} px, "
                "where {:.2f} px are expected",
                check.residual, check.noise);
  if (!check.explained())
    return line +
           "; no single change of port, lens or scale explains it. Check that the poses were "
           "refined with this lens and housing";
  return line + fmt::format(". Likely cause: {} ({:.2f} px); {}", cause_of(check.best, bundle),
                            check.best_residual, advice_for(check.best));
}

// The change with which the photographs agree clearly better than with the given cameras; the first
// of several.
std::optional<std::pair<PortChange, double>> change_by_pictures(const TrackPictures& pictures,
                                                                const Bundle& bundle,
                                                                double given) {
  std::optional<std::pair<PortChange, double>> best;
  for (const PortChange& change : likely_changes(bundle)) {
    if (change.of == PortChange::Of::port_left_out || change.of == PortChange::Of::focal_in_air)
      continue;
    const auto value = pictures.behind(changed(bundle, change));
    if (value) log_details("Photographs: {:.2f} with {}", *value, cause_of(change, bundle));
    if (value && *value > kAgreeWithChange && *value > given + kClearlyMore &&
        (!best || *value > best->second + 0.02))
      best = {change, *value};
  }
  return best;
}

// For tracks that fit cameras in air. They come from photographs in air, or their poses were
// computed without the port. The photographs tell which.
std::optional<std::string> by_pictures(const PortCheck& check, const io::ColmapModel& sample,
                                       const Bundle& in_air, const Bundle& bundle, bool ports,
                                       const std::filesystem::path& image_folder) {
  if (image_folder.empty()) return {};
  const TrackPictures pictures(sample, in_air, image_folder);
  const auto at_tracks = pictures.at_tracks();
  if (!at_tracks) return {};
  const auto agreement = pictures.behind(bundle);
  if (!agreement) return {};
  const double behind = *agreement;
  log_details("Photographs: {:.2f} at the tracks, {:.2f} where the cameras predict", *at_tracks,
              behind);
  if (ports && !check.fits() && *at_tracks > kAgree && *at_tracks > behind + kClearlyMore)
    return fmt::format(
        "The poses were computed without the port, for a pinhole camera: the sparse points have "
        "errors of {:.2f} px behind the ports, {:.2f} px without them, where {:.2f} px are "
        "expected, and the photographs agree with the tracks ({:.2f}) and not with the ports "
        "({:.2f}). RefinePoses, with the lens calibrated in air, computes refractive poses from "
        "them",
        check.residual, check.in_air, check.noise, *at_tracks, behind);
  if (*at_tracks > kAgree) return {};
  const double given = std::max(ports ? behind : *at_tracks, 0.0);
  const std::string what = fmt::format(
      "The photographs do not agree with {}: patches around the sparse points have a correlation "
      "of {:.2f}",
      ports ? "poses and ports" : "the poses", given);
  if (const auto better = change_by_pictures(pictures, bundle, given))
    return fmt::format("{}, and of {:.2f} with one change. Likely cause: {}; {}", what,
                       better->second, cause_of(better->first, bundle), advice_for(better->first));
  if (given >= kNothingInCommon || *at_tracks >= kNothingInCommon) return {};
  return fmt::format(
      "{}, and no single change of port, lens or scale explains it: check that the photographs "
      "belong to the poses and were taken {}",
      what, ports ? "through these ports" : "in air");
}

}  // namespace

std::optional<std::string> import_warning(const io::ColmapModel& model, const io::Housing& housing,
                                          const std::filesystem::path& image_folder) {
  try {
    const io::ColmapModel sample = sample_tracks(model);
    Bundle in_air = to_bundle(sample, sample.cameras, {}).bundle;
    triangulate(in_air);
    const Bundle bundle = behind_ports(in_air, sample, housing);
    const PortCheck check = check_ports(bundle, claimed_errors(sample));
    log_details("Tracks: {} points, {} observations, {:.3f} px off, {:.3f} px in air", check.points,
                check.observations, check.residual, check.in_air);
    if (!check.tells()) return {};
    const bool ports = std::ranges::any_of(bundle.cameras, [](const BundleCamera& camera) {
      return camera.measured.port.has_value();
    });
    // A model with ports has tracks of photographs taken through these ports.
    const bool carried = std::ranges::any_of(
        sample.cameras, [](const io::ColmapCamera& camera) { return camera.port.has_value(); });
    if (check.fits_in_air() && !carried)
      return by_pictures(check, sample, in_air, bundle, ports, image_folder);
    if (check.fits()) return {};
    return misfit(check, bundle, ports);
  } catch (const Error&) {
    return {};  // an unsupported lens, or an image whose rays do not reach its port
  }
}

}  // namespace axial::pose
