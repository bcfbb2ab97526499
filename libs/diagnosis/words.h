// SPDX-License-Identifier: GPL-3.0-or-later
// The results of the checks in words: what was found, the likely cause, and what the user can do.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "axial/base.h"
#include "diagnosis/port_check.h"
#include "diagnosis/port_kind.h"
#include "diagnosis/refined_check.h"
#include "pose/refine.h"

namespace axial::diagnosis {

// Tracks that do not fit. `ports`: whether a camera is behind a port.
std::string text_of(const PortCheck& check, bool ports);

// A change with which photographs agree with the cameras, and their agreement (TrackPictures).
struct ChangeByPictures {
  PortChange change;
  double agreement = 0;
};

// Photographs that agree with the tracks and not with the cameras behind ports: `at_tracks` and
// `behind` are the results of TrackPictures.
std::string text_without_port(const PortCheck& check, double at_tracks, double behind);

// Photographs that do not agree with the cameras (`given`). `better`: the change that helps.
std::string text_by_pictures(double given, bool ports,
                             const std::optional<ChangeByPictures>& better);

// "no port", "a flat port" or "a dome".
std::string_view words_for(pose::PortKind kind);

// The photographs fit the kind of port `better` better than the kind `stated`.
std::string text_of(const KindFit& better, const KindFit& stated);

// A number that moved_numbers() found. `port`: the name of the camera's port.
std::string text_of(const pose::HousingNumber& moved, const std::string& port);

// The number `freed` and its two values. `scale_sigma`: Uncertainty::scale_sigma, the relative
// standard deviation of lengths. If it is 0 or infinite, the text does not mention lengths.
// Otherwise it says that lengths have a larger error than `scale_sigma`. It marks the
// setting "refine", the list of numbers to adjust (setting() in axial/base.h).
std::string text_of(const FreedNumber& freed, double scale_sigma);

// One line for each reason (errors, weak_images and weak_points of DropCounts) for which refine()
// dropped more than a quarter of the observations. `limits` are the limits that refine() used.
// Observations that repeat a point in an image are not counted. Only the line about large errors
// asks the user to check the housing, because the other reasons (few observations in an image,
// narrow angles) are properties of the survey.
std::vector<std::string> dropped_lines(const pose::RefineReport& report,
                                       const pose::TrackLimits& limits);

}  // namespace axial::diagnosis
