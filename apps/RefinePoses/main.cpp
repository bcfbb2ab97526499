// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/files_in.h"
#include "base/log.h"
#include "base/naming.h"
#include "base/parallel.h"
#include "base/same_file.h"
#include "base/unused_input.h"
#include "effective_lens.h"
#include "io/cameras/geo_offset.h"
#include "io/cameras/housing.h"
#include "io/cameras/other_ports.h"
#include "io/colmap/colmap.h"
#include "io/colmap/colmap_scene.h"
#include "left_out.h"
#include "options.h"
#include "pose/colmap_bundle.h"
#include "pose/freed_check.h"
#include "pose/known.h"
#include "pose/port_kind.h"
#include "pose/stated_check.h"
#include "position_lines.h"
#include "report.h"
#include "results.h"
#include "scale_from.h"
#include "usual_housing.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

using LensesInAir = std::vector<io::ColmapCamera>;

// A model, its lenses in air and its ports.
struct Input {
  fs::path folder;  // of the model
  io::ColmapModel model;
  LocalFrame frame;  // of the model
  LensesInAir lenses;
  io::Housing housing;
  std::optional<LeftOutPhotographs> left_out;  // with --database: photographs without a pose
};

// The lenses in air: from the file, or from the model if its cameras carry ports.
LensesInAir load_lenses(const Options& options, const io::ColmapModel& model) {
  if (options.lens.empty() && io::housing_of(model.cameras).ports.empty())
    fail("--lens is missing: the lens calibrated in air");
  LensesInAir lenses = options.lens.empty() ? model.cameras : io::read_colmap_cameras(options.lens);
  if (lenses.empty()) fail("{}: no camera", options.lens.string());
  return lenses;
}

pose::ColmapBundle load(const Options& options, const io::ColmapModel& model,
                        const LensesInAir& lenses, const io::Housing& housing) {
  try {
    return pose::to_bundle(model, lenses, housing);
  } catch (const Error& error) {
    fail("{}: {}", (options.lens.empty() ? options.model : options.lens).string(), error.what());
  }
}

// The ports of the lenses' file, and of the model's cameras where the lenses have none.
io::Housing carried_housing(const io::ColmapModel& model, const LensesInAir& lenses) {
  // A single lens applies to all cameras, whatever its id.
  if (lenses.size() == 1 && lenses.front().port)
    return io::housing_with(io::to_housing_port(*lenses.front().port));
  io::Housing carried = io::housing_of(lenses);
  io::Housing of_model = io::housing_of(model.cameras);
  carried.ports.merge(of_model.ports);
  carried.cameras.merge(of_model.cameras);
  return carried;
}

// The housing file, or the carried ports without one. Warns if carried ports that are not used
// differ.
io::Housing load_housing(const Options& options, const io::ColmapModel& model,
                         const LensesInAir& lenses) {
  if (!options.usual_housing.empty())
    return usual_housing(kind_named(options.usual_housing).value_or(pose::PortKind::flat));
  io::Housing carried = carried_housing(model, lenses);
  const std::string of_model = "the model in " + options.model.string();
  const std::string of_lens = options.lens.empty() ? of_model : options.lens.string();
  if (!options.housing.empty()) {
    io::Housing housing = io::read_housing(options.housing, model);
    io::refuse_water_surfaces(housing, options.housing);
    io::warn_of_other_ports(housing, options.housing.string(), carried, of_lens, model);
    return housing;
  }
  if (carried.ports.empty()) fail("--housing is missing: the port of the camera");
  io::warn_of_other_ports(carried, of_lens, io::housing_of(model.cameras), of_model, model);
  return carried;
}

// The input files: an output must not replace one.
std::vector<fs::path> inputs_of(const Options& options, const fs::path& model) {
  std::vector<fs::path> inputs{options.housing, options.database};
  constexpr std::string_view kPositions = "positions:";
  if (options.scale_from.starts_with(kPositions))
    inputs.push_back(options.parsed.common.working_folder /
                     options.scale_from.substr(kPositions.size()));
  for (const fs::path& folder : {model, options.lens})
    for (const fs::path& file : files_in(folder)) inputs.push_back(file);
  return inputs;
}

std::vector<fs::path> outputs_of(const Options& options) {
  std::vector<fs::path> outputs{options.output / "housing.json", options.output / "report.json"};
  for (const char* name : {"cameras", "images", "points3D"}) {
    const fs::path sparse = options.output / "sparse", other = options.output / "colmap-underwater";
    outputs.push_back(sparse / name += ".txt");
    for (const char* extension : {".txt", ".bin"})
      if (options.underwater) outputs.push_back(other / name += extension);
  }
  return outputs;
}

bool same_lens(const io::ColmapCamera& a, const io::ColmapCamera& b) {
  return a.model == b.model && std::ranges::equal(a.params, b.params, [](double x, double y) {
           return std::abs(x - y) <= 1e-9 * std::max(1.0, std::abs(x));
         });
}

// A model's camera with a port has its lens in air, too. Warns if that lens is not used and
// differs.
void warn_of_other_lenses(const Options& options, const io::ColmapModel& model,
                          const LensesInAir& lenses) {
  for (const io::ColmapCamera& camera : model.cameras) {
    const auto lens = std::ranges::find_if(lenses, [&](const io::ColmapCamera& candidate) {
      return lenses.size() == 1 || candidate.id == camera.id;
    });
    if (!camera.port || lens == lenses.end() || same_lens(*lens, camera)) continue;
    return log_warning(
        "The lenses of {} are used; the lenses of {} differ and are ignored, first for camera {}",
        options.lens.string(), options.model.string(), camera.id);
  }
}

// Called before the work: checks that the output can be written and does not replace the input.
void check_output(const Options& options, const fs::path& model) {
  std::error_code error;
  if (fs::equivalent(options.output / "sparse", model, error) ||
      fs::equivalent(options.output / "sparse", model.parent_path(), error))
    fail("--output-folder {}: its folder sparse/ is the model that is read",
         options.output.string());
  require_no_inputs(outputs_of(options), inputs_of(options, model), "--output-folder");
  io::require_no_binary_model(options.output / "sparse");
  require_writable_folder(options.output);
}

// Known positions place the model, so its local frame must be near them.
LocalFrame enter_local_frame(std::vector<pose::KnownPosition>& positions) {
  std::vector<Eigen::Vector3d> centres;
  centres.reserve(positions.size());
  for (const pose::KnownPosition& known : positions) centres.push_back(known.metres);
  const LocalFrame frame = frame_of(centres, {});
  if (frame.is_world()) return frame;
  for (pose::KnownPosition& known : positions) known.metres = frame.to_local(known.metres);
  return frame;
}

// Sets the known and unknown numbers of `options.refine.adjust`. `frame_of_model`: the frame of
// `bundle`. Returns the frame that the bundle will be in.
LocalFrame set_known(Options& options, const pose::Bundle& bundle, const LocalFrame& frame_of_model,
                     UnusedInput& unused) {
  pose::AdjustOptions& adjust = options.refine.adjust;
  adjust = {};
  options.dropped_positions =
      add_known(options.scale_from, options.scale_sigma, options.parsed.common.working_folder,
                bundle, adjust, unused);
  adjust.poses_known = options.poses == "known";
  pose::set_estimated_numbers(options.refine_list, options.sigmas, bundle, adjust,
                              options.parsed.option_of);
  options.refine.keep_stated = options.refine_list == "auto";
  return adjust.positions.empty() ? frame_of_model : enter_local_frame(adjust.positions);
}

// Writes lines of progress to the log.
class ProgressLines {
 public:
  void log(const std::string& line) {
    last_ = Clock::now();
    log_info("{}", line);
  }
  // Writes the line only if the last one is two seconds old, so that small models do not fill the
  // log.
  void log_if_due(const std::string& line) {
    if (Clock::now() - last_ >= std::chrono::seconds(2)) log(line);
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

// The bundle before refining, and the report of refining.
struct Refined {
  pose::Bundle before;
  pose::RefineReport report;
};

Refined refine(const Options& options, pose::ColmapBundle& refined) {
  pose::bring_to_metres(refined.bundle, options.refine.adjust);
  log_info("Starts with points at a median distance of {:.3g} m",
           pose::median_distance(refined.bundle));
  pose::Bundle before = refined.bundle;
  ProgressLines lines;
  pose::RefineReport report = naming(options.model, [&] {
    return pose::refine(
        refined.bundle, options.refine, [&](const std::string& line) { lines.log(line); },
        [&](const std::string& line) { lines.log_if_due(line); });
  });
  return {std::move(before), std::move(report)};
}

// Warns about images, positions and observations that were dropped, and if adjustment did not
// converge.
void warn(const pose::RefineReport& report, const pose::Bundle& bundle,
          const pose::RefineOptions& options, std::vector<std::string>& unused) {
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] == 0)
      log_warning("{}: left out: too few observations fit", bundle.images[i].name);
  for (const std::size_t position : lost_positions(bundle, options.adjust)) {
    unused.push_back("--scale-from: the position of " +
                     bundle.images[options.adjust.positions[position].image].name);
    log_warning("{} is not used, because this image is left out", unused.back());
  }
  for (const std::string& line : report.wrong_positions) {
    unused.push_back("--scale-from: " + line);
    log_warning("{}", unused.back());
  }
  for (const std::string& line : position_warnings(report)) log_warning("{}", line);
  if (report.repeated > 0)
    log_info(
        "{} observations are ignored, because another observation in the same image belongs to the "
        "same point",
        report.repeated);
  for (const std::string& line : pose::dropped_lines(report, options.tracks))
    log_warning("{}", line);
  if (!report.last.converged)
    log_warning("Not converged after {} iterations", report.last.iterations);
}

void write_model(const Options& options, const fs::path& folder, const io::ColmapModel& model,
                 const io::Housing& housing) {
  io::write_housing(folder / "housing.json", housing);
  if (options.underwater) {
    make_folder(folder / "colmap-underwater");
    io::write_underwater_text(folder / "colmap-underwater", model);
    io::write_underwater_binary(folder / "colmap-underwater", model);
  }
  make_folder(folder / "sparse");
  io::write_colmap_text(folder / "sparse", model);
}

// Writes the lens and the housing again, with the standard deviations of the results.
void write_sigmas(const Options& options, const pose::ColmapBundle& refined, const Input& input,
                  const pose::AdjustOptions& adjusted, const pose::Uncertainty& known) {
  const auto sigmas = pose::present_sigmas(refined.bundle, adjusted, &known);
  io::write_housing(options.output / "housing.json", to_housing(refined, input.housing, sigmas));
  io::write_colmap_cameras(options.output / "sparse" / "cameras.txt",
                           refined_cameras(refined, sigmas));
}

// Writes all files or none; then the files with standard deviations again.
void write(const Options& options, const pose::ColmapBundle& refined, const Input& input,
           const LocalFrame& frame, const Results& results) {
  const auto sigmas = pose::present_sigmas(refined.bundle, results.options, nullptr);
  const io::Housing housing = to_housing(refined, input.housing, sigmas);
  for (const auto& [name, port] : housing.ports) io::check_port(port, "The refined port " + name);
  io::ColmapModel result = to_model(refined, input.model, sigmas);
  io::leave(frame, result);
  // With fewer images, the parts of the work take less than a second.
  const bool is_long = refined.bundle.images.size() >= results.options.many_images;
  const auto log_if_long = [&](const std::string& line) {
    if (is_long) log_info("{}", line);
  };
  const pose::Uncertainty known = write_results(
      options.output,
      [&](const fs::path& folder) { write_model(options, folder, result, housing); }, results,
      [&] {
        log_info("Refined model in {}", options.output.string());
        result = {};
        pose::Uncertainty found = pose::uncertainty(refined.bundle, results.options, log_if_long);
        write_sigmas(options, refined, input, results.options, found);
        return found;
      });
  for (const std::string& line : uncertainty_lines(results, known)) log_info("{}", line);
  if (const auto line = scale_warning(results, known)) log_warning("{}", *line);
  if (results.is_other_kind) return;  // numbers of the wrong kind are no cause
  for (const std::string& line :
       pose::lines_of_moved_numbers(refined.bundle, refined.ports, results.options))
    log_warning("{}", line);
  if (const auto freed = pose::number_that_does_not_fit(refined.bundle, results.options))
    log_warning("{}", pose::warning_of(*freed,
                                       results.scale_lost ? std::numeric_limits<double>::infinity()
                                                          : known.scale_sigma,
                                       options.parsed.option_of));
}

Input read_input(const Options& options) {
  Input input;
  input.folder = io::find_colmap_model(options.model);
  input.model = io::read_colmap_model(input.folder);
  // In world coordinates of millions of metres the solver would stop too early, because its steps
  // are small relative to the coordinates.
  input.frame = io::enter_local_frame(input.model);
  input.lenses = load_lenses(options, input.model);
  warn_of_other_lenses(options, input.model, input.lenses);
  if (options.poses == "known" && !options.database.empty())
    log_info("{} is not read, because the poses are known", options.database.string());
  else if (!options.database.empty())
    input.left_out = add_left_out(options.database, input.lenses, input.model);
  input.housing = load_housing(options, input.model, input.lenses);
  return input;
}

// Warns of entries of the housing that match no image or camera. Error if no image is behind a
// port.
void check_ports(const Options& options, const Input& input, const pose::Bundle& bundle) {
  const fs::path& ports_from = !options.housing.empty() ? options.housing
                               : options.lens.empty()   ? options.model
                                                        : options.lens;
  for (const std::string& entry : io::unused_entries(input.housing, input.model))
    log_warning("{}: no image matches {}", ports_from.string(), entry);
  if (std::ranges::none_of(bundle.cameras, [](const pose::BundleCamera& camera) {
        return camera.measured.port.has_value();
      }))
    fail("no image is behind a port: there is nothing to refine");
}

void say_input(const Input& input, const pose::ColmapBundle& bundle) {
  log_info("{}: {} images, {} points, {} observations", input.folder.string(),
           input.model.images.size(), input.model.points.size(), bundle.bundle.observations.size());
  if (bundle.unseen > 0)
    log_warning("{} observations lie at pixels for which the lens in air has no ray",
                bundle.unseen);
}

// Refines the bundle. If refining drops the images or points that --scale-from names, reports this
// to `unused`, clears --scale-from, and refines once more from the start. `frame` is then the frame
// of the new bundle.
Refined refine_or_without_scale(Options& options, pose::ColmapBundle& refined, const Input& input,
                                UnusedInput& unused, LocalFrame& frame) {
  std::optional<pose::ColmapBundle> start;
  if (options.allow_missing && !options.scale_from.empty()) start = refined;
  Refined done = refine(options, refined);
  if (done.report.lost.empty()) return done;
  unused.report("--scale-from " + options.scale_from + ": " + done.report.lost.front());
  options.scale_from.clear();
  refined = *std::move(start);
  frame = set_known(options, refined.bundle, input.frame, unused);
  return refine(options, refined);
}

std::string text_of(const pose::KindFit& better, const pose::KindFit& stated) {
  const std::string kind = better.kind == pose::PortKind::none
                               ? "no port, or a dome around the camera centre,"
                               : std::string(pose::words_for(better.kind));
  // The numbers of a wrong kind may hide the errors.
  const std::string numbers =
      stated.strain > 3
          ? fmt::format(" after a stated number changed by {:.0f} standard deviations",
                        stated.strain)
          : std::string();
  return fmt::format(
      "The photographs fit {} better than {}: errors are {:.3g} px instead of {:.3g} px{}", kind,
      pose::words_for(stated.kind), better.error, stated.error, numbers);
}

// A kind of port that the photographs fit better than the stated kind.
struct OtherKind {
  pose::PortKind kind;
  std::string evidence;
};

// `before`: the bundle before refining, in metres. Nothing if no kind was stated.
std::optional<OtherKind> other_kind(const Options& options, const pose::Bundle& before) {
  const pose::AdjustOptions& adjust = options.refine.adjust;
  if (!options.usual_housing.empty() || adjust.poses_known) return {};
  const std::vector<pose::KindFit> fits = pose::fits_of_kinds(before, adjust);
  const std::optional<pose::KindFit> better = pose::better_kind(fits);
  if (!better) return {};
  return OtherKind{better->kind, text_of(*better, fits.front())};
}

bool are_possible(const io::Housing& housing) {
  try {
    for (const auto& [name, port] : housing.ports) io::check_port(port, name);
    return true;
  } catch (const Error&) {
    return false;
  }
}

// The kind of port with which the poses are refined again, after a warning: the photographs fit
// this kind better than the stated kind, whose numbers moved so far that the refined port is
// impossible.
std::optional<pose::PortKind> kind_for_second_try(const Options& options, const Input& input,
                                                  const pose::ColmapBundle& refined,
                                                  const Refined& done) {
  if (are_possible(to_housing(refined, input.housing))) return {};
  const std::optional<OtherKind> other = other_kind(options, done.before);
  if (!other || other->kind == pose::PortKind::none) return {};
  log_warning(
      "{}; the poses are refined again, with the usual numbers of {}: state the right kind "
      "of housing",
      other->evidence, pose::words_for(other->kind));
  return other->kind;
}

// Tells the errors, checks the result, and writes it. `frame`: of the refined bundle.
void finish(const Options& options, const Input& input, const pose::ColmapBundle& refined,
            const Refined& done, const UnusedInput& unused, const LocalFrame& frame,
            const std::optional<Registered>& registered) {
  const bool scale_lost = !unused.lines().empty();
  if (scale_lost) log_warning("The model has no scale: --scale-from is not used");
  Results results{done.report,
                  errors_by_image(done.before, refined.bundle),
                  refined.bundle,
                  refined.ports,
                  options.refine.adjust,
                  unused.lines(),
                  scale_lost};
  for (const std::string& line : error_lines(results)) log_info("{}", line);
  for (const std::string& line : position_lines(done.report)) log_info("{}", line);
  for (const std::string& line : options.dropped_positions)
    results.unused.push_back("--scale-from: " + line);
  warn(done.report, refined.bundle, options.refine, results.unused);
  if (registered) results.registered = &*registered;
  if (const auto other = other_kind(options, done.before)) {
    results.is_other_kind = true;
    log_warning("{}; state the right kind of housing, or let --housing unknown find it",
                other->evidence);
  }
  write(options, refined, input, frame, results);
}

// The kind of port that the photographs fit best, for --housing unknown. `bundle` has usual flat
// ports.
pose::PortKind likely_kind(pose::Bundle bundle, const pose::AdjustOptions& adjust) {
  pose::bring_to_metres(bundle, adjust);
  const std::vector<pose::KindFit> fits = pose::fits_of_kinds(bundle, adjust);
  const auto better = pose::better_kind(fits);
  for (const pose::KindFit& fit : fits)
    log_info("With {}, errors are {:.3g} px", pose::words_for(fit.kind), fit.error);
  // Without a port, cameras are those behind a dome around the camera centre.
  const pose::PortKind kind = better ? pose::PortKind::dome : pose::PortKind::flat;
  log_info("The housing is taken for {}", pose::words_for(kind));
  return kind;
}

// Gives poses to photographs that COLMAP left out, and changes the model in `input`. Known
// positions are not used yet.
Registered register_left_out(const Options& options, Input& input) {
  pose::Bundle bundle = load(options, input.model, input.lenses, input.housing).bundle;
  pose::RefineOptions refining = options.refine;
  refining.adjust.distances = known_lengths(options.scale_from, options.scale_sigma, bundle);
  if (options.usual_housing == "unknown") {
    pose::bring_to_metres(bundle, refining.adjust);
    if (pose::better_kind(pose::fits_of_kinds(bundle, refining.adjust)))
      bundle = load(options, input.model, input.lenses, usual_housing(pose::PortKind::dome)).bundle;
  }
  pose::set_estimated_numbers(options.refine_list, options.sigmas, bundle, refining.adjust,
                              options.parsed.option_of);
  log_info("{}: seeks poses of {} photographs without a pose among {} with poses",
           options.database.string(), input.model.images.size() - input.left_out->first,
           input.left_out->first);
  Registered registered = naming(options.model, [&] {
    return register_left_out(input.model, *input.left_out, std::move(bundle), refining,
                             [](const std::string& line) { log_info("Registering: {}", line); });
  });
  input.left_out.reset();
  const RegisteredLines lines = lines_about(registered);
  for (const std::string& line : lines.infos) log_info("{}", line);
  for (const std::string& line : lines.warnings) log_warning("{}", line);
  return registered;
}

int run_effective_lens(const Options& options) {
  const std::vector<fs::path> inputs{options.lens, options.housing};
  require_not_an_input(options.effective_lens, inputs, "--effective-lens");
  const LensesInAir lenses = load_lenses(options, {});
  write_effective_lenses(options.effective_lens, lenses, load_housing(options, {}, lenses),
                         options.scene_distance, options.lens);
  return 0;
}

int run(int argc, char** argv) {
  Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const ThreadLimit threads(options.parsed.common.max_threads);
  if (!options.effective_lens.empty()) return run_effective_lens(options);
  Input input = read_input(options);
  check_output(options, input.folder);
  std::optional<Registered> registered;
  // With poses of all photographs, the tracks are those of COLMAP.
  if (input.left_out && input.left_out->any(input.model))
    registered = register_left_out(options, input);
  pose::ColmapBundle refined = load(options, input.model, input.lenses, input.housing);
  check_ports(options, input, refined.bundle);
  UnusedInput unused(options.allow_missing);
  LocalFrame frame = set_known(options, refined.bundle, input.frame, unused);
  const auto start_with = [&](pose::PortKind kind) {
    input.housing = usual_housing(kind);
    refined = load(options, input.model, input.lenses, input.housing);
    frame = set_known(options, refined.bundle, input.frame, unused);
  };
  if (options.usual_housing == "unknown" &&
      likely_kind(refined.bundle, options.refine.adjust) == pose::PortKind::dome)
    start_with(pose::PortKind::dome);
  say_input(input, refined);
  Refined done = refine_or_without_scale(options, refined, input, unused, frame);
  if (const auto kind = kind_for_second_try(options, input, refined, done)) {
    start_with(*kind);
    options.usual_housing = "unknown";
    done = refine_or_without_scale(options, refined, input, unused, frame);
  }
  options.refine.adjust.positions = done.report.positions;
  finish(options, input, refined, done, unused, frame, registered);
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("RefinePoses", [&] { return axial::apps::run(argc, argv); });
}
