// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <chrono>

#include "base/error.h"
#include "base/log.h"
#include "base/naming.h"
#include "diagnosis/words.h"
#include "scale_from.h"
#include "stages.h"
#include "usual_housing.h"

namespace axial::apps {
namespace {

// Known positions and places place the model, so its local frame must be near them. Known poses,
// and models that nothing places in the plane, keep the frame of the model.
LocalFrame frame_of_result(const LocalFrame& of_model, const pose::AdjustOptions& adjust) {
  std::vector<Eigen::Vector3d> known = places_in_plan(adjust.places);
  for (const pose::KnownPosition& position : adjust.positions) known.push_back(position.metres);
  return adjust.poses_known || known.empty() ? of_model : frame_of(known, {});
}

// Moves all known coordinates to the frame of the result, and returns this frame.
LocalFrame enter_local_frame(const LocalFrame& of_model, pose::AdjustOptions& adjust,
                             std::vector<pose::KnownPlace>& checks) {
  const LocalFrame frame = frame_of_result(of_model, adjust);
  for (pose::KnownPosition& position : adjust.positions)
    position.metres = frame.to_local(position.metres);
  enter(frame, adjust.places);
  enter(frame, checks);
  return frame;
}

// The kind of port for --housing unknown. `bundle` is behind usual flat ports and is brought to
// metres. `context` gets the errors of each kind. Without a port, cameras are those behind a dome
// around the camera centre.
pose::PortKind likely_kind(pose::Bundle& bundle, const pose::AdjustOptions& adjust,
                           const Context& context) {
  pose::bring_to_metres(bundle, adjust);
  const std::vector<diagnosis::KindFit> fits = diagnosis::fits_of_kinds(bundle, adjust);
  const auto better = diagnosis::better_kind(fits);
  for (const diagnosis::KindFit& fit : fits)
    context.info("With {}, errors are {:.3g} px", diagnosis::words_for(fit.kind), fit.error);
  return better ? pose::PortKind::dome : pose::PortKind::flat;
}

bool are_possible(const io::Housing& housing) {
  try {
    for (const auto& [name, port] : housing.ports) io::check_port(port, name);
    return true;
  } catch (const Error&) {
    return false;
  }
}

// Refines a bundle from its start, and again if its input must change.
class Refining {
 public:
  Refining(Options& options, Input& input, UnusedInput& unused, const Context& context)
      : options_(options), input_(input), unused_(unused), context_(context) {
    refined_.after = bundle_of(options, input, input.housing);
    check_ports(options, input, bundle());
    set_known();
  }

  void find_unknown_kind();
  void refine_with_or_without_scale();
  void try_another_kind();
  void tell_input() const;
  Refined take();

 private:
  const pose::Bundle& bundle() const { return refined_.after.bundle; }
  void set_known();
  // Makes the bundle anew, with the present housing of the input.
  void start_again() {
    refined_.after = bundle_of(options_, input_, input_.housing);
    set_known();
  }
  void start_with(pose::PortKind kind) {
    input_.housing = usual_housing(kind);
    start_again();
  }
  void refine_once();

  Options& options_;
  Input& input_;
  UnusedInput& unused_;
  const Context& context_;
  Refined refined_;
};

void Refining::set_known() {
  pose::AdjustOptions& adjust = options_.refine.adjust;
  adjust = {};
  options_.dropped_positions =
      add_known(options_.scale_from, options_.scale_sigma, options_.parsed.common.working_folder,
                bundle(), adjust, unused_, context_);
  options_.refine.targets.clear();
  refined_.control = {};
  if (options_.control.any())
    refined_.control = add_control(input_.control, refined_.after.bundle, options_.refine);
  adjust.poses_known = options_.poses == "known";
  refined_.after.bundle.rigs = read_rigs(options_.rigs, input_.model);
  scale_stated(refined_.after.bundle.rigs, refined_.control.map_scale);
  pose::set_estimated_numbers(options_.refine_list, options_.sigmas, bundle(), adjust);
  options_.refine.keep_stated = options_.refine_list == "auto";
  refined_.frame = enter_local_frame(input_.frame, adjust, refined_.control.checks.places);
}

void Refining::find_unknown_kind() {
  if (options_.usual_housing != "unknown") return;
  pose::Bundle bundle = refined_.after.bundle;
  const pose::PortKind kind = likely_kind(bundle, options_.refine.adjust, context_);
  log_info("The housing is taken for {}", diagnosis::words_for(kind));
  if (kind == pose::PortKind::dome) start_with(kind);
}

void Refining::tell_input() const {
  log_info("{}: {} images, {} points, {} observations", input_.folder.string(),
           input_.model.images.size(), input_.model.points.size(), bundle().observations.size());
  for (const std::string& line : input_lines(bundle().rigs)) log_info("{}", line);
  if (const double scale = refined_.control.map_scale; scale != 1)
    log_info(
        "One metre is {:.5f} m on the map of the control points: known lengths are multiplied "
        "by this factor",
        scale);
  if (refined_.after.unseen > 0)
    log_warning("{} observations lie at pixels for which the lens in air has no ray",
                refined_.after.unseen);
}

void Refining::refine_once() {
  pose::Bundle& bundle = refined_.after.bundle;
  pose::bring_to_metres(bundle, options_.refine.adjust);
  log_info("Starts with points at a median distance of {:.3g} m", pose::median_distance(bundle));
  refined_.before = bundle;
  refined_.report =
      naming(options_.model, [&] { return pose::refine(bundle, options_.refine, context_); });
}

// If refining drops the images or points that --scale-from names, reports this, clears
// --scale-from, and refines once more from the start.
void Refining::refine_with_or_without_scale() {
  refine_once();
  if (refined_.report.lost.empty()) return;
  unused_.report("--scale-from " + options_.scale_from + ": " + refined_.report.lost.front(),
                 context_);
  options_.scale_from.clear();
  start_again();
  refine_once();
}

// Refines again, after a warning, with a kind of port that the photographs fit better than the
// stated kind, if the numbers of the stated kind moved so far that the refined port is impossible.
void Refining::try_another_kind() {
  if (are_possible(to_housing(refined_.after, input_.housing))) return;
  const std::optional<OtherKind> other = other_kind(options_, refined_.before);
  if (!other || other->kind == pose::PortKind::none) return;
  log_warning(
      "{}; the poses are refined again, with the usual numbers of {}: state the right kind "
      "of housing",
      other->evidence, diagnosis::words_for(other->kind));
  start_with(other->kind);
  options_.usual_housing = "unknown";
  refine_with_or_without_scale();
}

// The result. uncertainty() needs the known values that the last adjustment used.
Refined Refining::take() {
  options_.refine.adjust.positions = refined_.report.positions;
  options_.refine.adjust.distances = refined_.report.distances;
  options_.refine.adjust.places = refined_.report.places;
  return std::move(refined_);
}

}  // namespace

std::optional<Registered> register_photographs(const Options& options, Input& input,
                                               const Context& context) {
  // With poses of all photographs, the tracks are those of COLMAP.
  if (!input.left_out || !input.left_out->any(input.model)) return {};
  pose::Bundle bundle = bundle_of(options, input, input.housing).bundle;
  pose::RefineOptions refining = options.refine;
  refining.adjust.distances = known_lengths(options.scale_from, options.scale_sigma, bundle);
  if (options.usual_housing == "unknown" &&
      likely_kind(bundle, refining.adjust, Context()) == pose::PortKind::dome)
    bundle = bundle_of(options, input, usual_housing(pose::PortKind::dome)).bundle;
  pose::set_estimated_numbers(options.refine_list, options.sigmas, bundle, refining.adjust);
  log_info("{}: seeks poses of {} photographs without a pose among {} with poses",
           options.database.string(), input.model.images.size() - input.left_out->first,
           input.left_out->first);
  const Context registering(context.with_prefix("Registering: "), context.stop_token());
  Registered registered = naming(options.model, [&] {
    return register_left_out(input.model, *input.left_out, std::move(bundle), refining,
                             registering);
  });
  input.left_out.reset();
  log_registered(registered);
  return registered;
}

Refined refine(Options& options, Input& input, UnusedInput& unused, const Context& context) {
  Refining refining(options, input, unused, context);
  refining.find_unknown_kind();
  refining.tell_input();
  refining.refine_with_or_without_scale();
  refining.try_another_kind();
  return refining.take();
}

}  // namespace axial::apps
