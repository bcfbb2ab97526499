// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>

#include "base/error.h"
#include "base/log.h"
#include "diagnosis/words.h"
#include "pose/adjust/uncertainty.h"
#include "pose/bundle/known.h"
#include "stages.h"

namespace axial::apps {
namespace {

void warn_of_lost_input(const Options& options, const Refined& refined, Results& results) {
  const pose::Bundle& bundle = refined.after.bundle;
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] == 0)
      log_warning("{}: left out: too few observations fit", bundle.images[i].name);
  const pose::AdjustOptions& adjust = options.refine.adjust;
  for (const std::size_t position : lost_positions(bundle, adjust)) {
    results.unused.push_back("--scale-from: the position of " +
                             bundle.images[adjust.positions[position].image].name);
    log_warning("{} is not used, because this image is left out", results.unused.back());
  }
  for (const std::string& line : refined.report.wrong_positions) {
    results.unused.push_back("--scale-from: " + line);
    log_warning("{}", results.unused.back());
  }
}

}  // namespace

std::optional<OtherKind> other_kind(const Options& options, const pose::Bundle& before) {
  const pose::AdjustOptions& adjust = options.refine.adjust;
  if (!options.usual_housing.empty() || adjust.poses_known) return {};
  const std::vector<diagnosis::KindFit> fits = diagnosis::fits_of_kinds(before, adjust);
  const std::optional<diagnosis::KindFit> better = diagnosis::better_kind(fits);
  if (!better) return {};
  return OtherKind{better->kind, diagnosis::text_of(*better, fits.front())};
}

void judge(const Options& options, const Refined& refined, Results& results) {
  const pose::RefineReport& report = refined.report;
  warn_of_lost_input(options, refined, results);
  for (const std::string& line : position_warnings(report)) log_warning("{}", line);
  if (report.repeated > 0)
    log_info(
        "{} observations are ignored, because another observation in the same image belongs to the "
        "same point",
        report.repeated);
  for (const std::string& line : diagnosis::dropped_lines(report, options.refine.tracks))
    log_warning("{}", line);
  if (!report.last.converged)
    log_warning("Not converged after {} iterations", report.last.iterations);
  if (const auto other = other_kind(options, refined.before)) {
    results.is_other_kind = true;
    log_warning("{}; state the right kind of housing, or let --housing unknown find it",
                other->evidence);
  }
}

void judge_numbers(const pose::Uncertainty& known, const Results& results) {
  if (const auto line = scale_warning(results, known)) log_warning("{}", *line);
  if (const auto line = shape_warning(results, known)) log_warning("{}", *line);
  if (const auto line = depth_warning(known)) log_warning("{}", *line);
  if (results.is_other_kind) return;  // numbers of the wrong kind are no cause
  for (const pose::HousingNumber& moved : diagnosis::moved_numbers(results.bundle, results.options))
    log_warning("{}", diagnosis::text_of(moved, results.ports[moved.camera]));
  const double scale_sigma =
      results.scale_lost ? std::numeric_limits<double>::infinity() : known.scale_sigma;
  if (const auto freed = diagnosis::number_that_does_not_fit(results.bundle, results.options))
    log_warning("{}", diagnosis::text_of(*freed, scale_sigma));
}

}  // namespace axial::apps
