// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/program/unused_input.h"
#include "pose/bundle/adjust_options.h"

namespace axial::apps {

// The standard deviation of known lengths or positions [m], the value of the option --scale-sigma.
struct ScaleSigma {
  double metres = 0.001;
  bool given = false;  // by the user
};

// The standard deviation of positions that is taken until it is estimated [m].
inline constexpr double kGuessedPositionSigma = 0.1;

// Adds the known lengths or positions of the option --scale-from to `adjust`. Lengths have the
// standard deviation `sigma`. Positions have it only if the user gave it; otherwise their standard
// deviation is kGuessedPositionSigma and counts as a guess (KnownPosition::sigma_is_guess).
// `scale_from` is the value of the option; an empty value adds
// nothing. Its forms are:
//
//     images:NAME,NAME,METRES   the distance of two camera centres
//     points:ID,ID,METRES       the distance of two points of the model
//     positions:FILE            camera centres, a file of io::positions_of_images; at least three,
//                               and not all on one line. Standard deviations in the file replace
//                               those of `sigma` and the guess.
//
// A NAME that contains a comma must be written in double quotes, and a double quote inside the name
// as "". The quotes may be left out if the names of the model allow only one reading.
//
// Error that names the option or file, and the mistake. Some valid input cannot be used with this
// model: no such image or point, both ends in one place, too few positions, all positions on one
// line, or all on one line but one that does not fit, or positions whose unit or order the file
// does not state and the cameras do not tell (io::UnclearUnit). Such input is reported to `unused`,
// and `adjust` stays as it is. Positions of images without a pose are skipped, with a warning for
// each, because the list of a survey may name more photographs. Positions that do not fit the
// others (robust_similarity in scene/robust_similarity.h) are left out with a warning, and these
// lines are returned. Positions of a mirrored frame are an error.
std::vector<std::string> add_known(const std::string& scale_from, const ScaleSigma& sigma,
                                   const std::filesystem::path& working_folder,
                                   const pose::Bundle& bundle, pose::AdjustOptions& adjust,
                                   UnusedInput& unused, const Context& context);

// The known lengths of `scale_from`, as add_known() adds them, without messages. Empty if there are
// none or if they cannot be used.
std::vector<pose::KnownDistance> known_lengths(const std::string& scale_from,
                                               const ScaleSigma& sigma, const pose::Bundle& bundle);

}  // namespace axial::apps
