// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/words.h"

#include <fmt/format.h>

#include <cmath>

namespace axial::diagnosis {
namespace {

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

}  // namespace

std::string text_of(const PortCheck& check, bool ports) {
  const std::string line =
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
  return line + fmt::format(". Likely cause: {} ({:.2f} px); {}", check.best.cause,
                            check.best_residual, check.best.advice);
}

std::string text_without_port(const PortCheck& check, double at_tracks, double behind) {
  return fmt::format(
      "The poses were computed without the port, for a pinhole camera: the sparse points have "
      "errors of {:.2f} px behind the ports, {:.2f} px without them, where {:.2f} px are "
      "expected, and the photographs agree with the tracks ({:.2f}) and not with the ports "
      "({:.2f}). RefinePoses, with the lens calibrated in air, computes refractive poses from "
      "them",
      check.residual, check.in_air, check.noise, at_tracks, behind);
}

std::string text_by_pictures(double given, bool ports,
                             const std::optional<ChangeByPictures>& better) {
  const std::string what = fmt::format(
      "The photographs do not agree with {}: patches around the sparse points have a correlation "
      "of {:.2f}",
      ports ? "poses and ports" : "the poses", given);
  if (better)
    return fmt::format("{}, and of {:.2f} with one change. Likely cause: {}; {}", what,
                       better->agreement, better->change.cause, better->change.advice);
  return fmt::format(
      "{}, and no single change of port, lens or scale explains it: check that the photographs "
      "belong to the poses and were taken {}",
      what, ports ? "through these ports" : "in air");
}

std::string_view words_for(pose::PortKind kind) {
  switch (kind) {
    case pose::PortKind::none:
      return "no port";
    case pose::PortKind::flat:
      return "a flat port";
    case pose::PortKind::dome:
      return "a dome";
  }
  return {};
}

std::string text_of(const KindFit& better, const KindFit& stated) {
  const std::string kind = better.kind == pose::PortKind::none
                               ? "no port, or a dome around the camera centre,"
                               : std::string(words_for(better.kind));
  // The numbers of a wrong kind may hide the errors.
  const std::string numbers =
      stated.strain > 3
          ? fmt::format(" after a stated number changed by {:.0f} standard deviations",
                        stated.strain)
          : std::string();
  return fmt::format(
      "The photographs fit {} better than {}: errors are {:.3g} px instead of {:.3g} px{}", kind,
      words_for(stated.kind), better.error, stated.error, numbers);
}

std::string text_of(const pose::HousingNumber& moved, const std::string& port) {
  return fmt::format(
      "Camera {} behind {}: the photographs give {} {}, {:.1f} standard deviations from the "
      "stated {} +- {}: check this value, the lens in air and the kind of the port",
      moved.camera + 1, port, moved.name, with_unit(moved.now, moved.unit),
      std::abs(moved.change) / moved.sigma_before, with_unit(moved.before, moved.unit),
      with_unit(moved.sigma_before, moved.unit));
}

std::string text_of(const FreedNumber& freed, double scale_sigma) {
  const pose::HousingNumber& number = freed.number;
  const std::string deviations = freed.deviations < 100 ? fmt::format("{:.0f}", freed.deviations)
                                                        : std::string("more than 100");
  const std::string lengths =
      std::isfinite(scale_sigma) && scale_sigma > 0
          ? fmt::format("The lengths then have a larger error than {:.2g} %. ", 100 * scale_sigma)
          : std::string();
  return fmt::format(
      "Lens, port and scale do not fit the photographs: with {} at {} (given: {}, {} standard "
      "deviations away), errors are {:.3f} px instead of {:.3f} px (RMS), and the scene changes by "
      "{:.2g} % of its distance. {}Measure this value again, or adjust it with {}",
      number.name, with_unit(number.now, number.unit), with_unit(number.before, number.unit),
      deviations, freed.rms_found, freed.rms_stated, 100 * freed.effect, lengths,
      setting("refine"));
}

std::vector<std::string> dropped_lines(const pose::RefineReport& report,
                                       const pose::TrackLimits& limits) {
  const std::size_t distinct = report.observations_before - report.repeated;
  const auto many = [&](std::size_t count) { return 4 * count > distinct; };
  const pose::DropCounts& dropped = report.dropped;
  std::vector<std::string> lines;
  if (many(dropped.errors))
    lines.push_back(
        fmt::format("{} of {} observations have errors above {:.3g} px and are dropped: check the "
                    "housing and the lens in air",
                    dropped.errors, distinct, limits.max_error));
  if (many(dropped.weak_images))
    lines.push_back(
        fmt::format("{} of {} observations belong to images with fewer than {} observations that "
                    "fit, and are left out",
                    dropped.weak_images, distinct, limits.min_observations));
  if (many(dropped.weak_points))
    lines.push_back(
        fmt::format("{} of {} observations belong to points that only one image sees, or that are "
                    "seen under less than {:.3g} degrees, and are left out",
                    dropped.weak_points, distinct, limits.min_angle));
  return lines;
}

}  // namespace axial::diagnosis
