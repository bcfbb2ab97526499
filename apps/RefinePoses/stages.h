// SPDX-License-Identifier: GPL-3.0-or-later
// The stages of RefinePoses, in their order: reading, registering, refining, judging, writing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/program/unused_input.h"
#include "control.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "left_out.h"
#include "options.h"
#include "pose/adjust/uncertainty.h"
#include "pose/bundle/housing_numbers.h"
#include "pose/colmap_bundle.h"
#include "pose/refine.h"
#include "report.h"
#include "scene/local_frame.h"

namespace axial::apps {

// A model, its lenses in air and its ports.
struct Input {
  std::filesystem::path folder;  // of the model
  io::ColmapModel model;
  LocalFrame frame;  // of the model
  std::vector<io::ColmapCamera> lenses;
  io::Housing housing;
  control::Control control;                    // with --targets
  std::optional<LeftOutPhotographs> left_out;  // with --database: photographs without a pose
};

// The lenses in air: of --lens, or of the model if its cameras carry ports.
std::vector<io::ColmapCamera> load_lenses(const Options& options, const io::ColmapModel& model,
                                          const Context& context);

// The ports of --housing, or those that the lenses or the model carry. Warns if carried ports that
// are not used differ.
io::Housing load_housing(const Options& options, const io::ColmapModel& model,
                         const std::vector<io::ColmapCamera>& lenses, const Context& context);

// Reads all input. Warns if lenses that are not used differ. The three functions throw an Error
// that names the file or the option.
Input read_input(const Options& options, const Context& context);

// Called before the work: checks that the output can be written and does not replace the input.
void check_output(const Options& options, const Input& input);

// The bundle of the input with the ports of `housing`. An Error names the file of the lenses.
pose::ColmapBundle bundle_of(const Options& options, const Input& input,
                             const io::Housing& housing);

// Warns of entries of the housing that match no image or camera. Error if no image is behind a
// port.
void check_ports(const Options& options, const Input& input, const pose::Bundle& bundle);

// Gives poses to photographs that COLMAP left out, if there are any, and changes the model of
// `input`. Known positions are not used yet.
std::optional<Registered> register_photographs(const Options& options, Input& input,
                                               const Context& context);

// The bundle before refining, in metres, and after it.
struct Refined {
  pose::Bundle before;
  pose::ColmapBundle after;
  pose::RefineReport report;
  LocalFrame frame;      // of both bundles
  AddedControl control;  // with --targets
};

// Refines the bundle of `input`. The housing of `input` becomes a usual housing if --housing
// unknown is given and the photographs fit a dome, or if the stated kind of port ends in an
// impossible port and the photographs fit another kind. Input that --scale-from names and that
// cannot be used is reported to `unused`; the bundle is then refined without it. Sets the known and
// unknown numbers of `options.refine.adjust`. Progress goes to the log.
Refined refine(Options& options, Input& input, UnusedInput& unused, const Context& context);

// A kind of port that the photographs fit better than the stated kind.
struct OtherKind {
  pose::PortKind kind;
  std::string evidence;
};

// `before`: the bundle before refining, in metres. Nothing if no kind was stated.
std::optional<OtherKind> other_kind(const Options& options, const pose::Bundle& before);

// Warns about images, positions and observations that were dropped, if adjustment did not converge,
// and about another kind of port, which is noted in `results`. Lines about known values that were
// not used are added to Results::unused.
void judge(const Options& options, const Refined& refined, Results& results);

// Warns about numbers of lens and port that do not fit the photographs, and about an unknown scale.
// `known`: the standard deviations of the refined bundle.
void judge_numbers(const pose::Uncertainty& known, const Results& results);

// Writes all files of the output folder by write_results(); then the lens and the housing again,
// with their standard deviations. Sets Results::control. Returns the standard deviations. Error if
// a refined port is impossible.
pose::Uncertainty write(const Options& options, const Input& input, const Refined& refined,
                        Results& results, const Context& context);

}  // namespace axial::apps
