// SPDX-License-Identifier: GPL-3.0-or-later
// Which kind of port photographs were taken through, by their tracks.
#pragma once

#include <optional>
#include <vector>

#include "pose/bundle/adjust_options.h"
#include "pose/bundle/housing_numbers.h"

namespace axial::diagnosis {

// A port of this kind with the usual numbers of divers' housings: a flat port of 8 mm of glass, 5
// cm from the camera centre and across the optical axis; a dome of 8 mm of glass with an inner
// radius of 6 cm around the camera centre. The index of glass is 1.5, that of the water 1.339,
// between those of fresh water and of the sea. Nothing for PortKind::none.
std::optional<refractive::Port<double>> usual_port(pose::PortKind kind);

// How far usual_port() and a lens in air may be from the truth: 3 degrees for the normal, 3 cm for
// the distance, 1 cm for the centre of a dome, 0.004 for the index of the water, and 0.5 % for the
// focal length.
pose::Sigmas usual_sigmas();

// How well a kind of port fits.
struct KindFit {
  pose::PortKind kind = pose::PortKind::none;
  // The square root of the mean cost of an observation [px]: about the RMS reprojection error.
  // Errors above 2 px count linearly, as in adjust(), and deviations from measured numbers count,
  // too.
  double error = 0;
  double cost = 0;    // sum of squares, in standard deviations
  double strain = 0;  // the largest change of a measured number, in its standard deviations
};

// Fits each kind of port to a part of the bundle: at most 40 images and 600 points. The cameras
// have usual_port(). For the kind that is stated, their stated ports are tried, too, and the better
// fit counts. Poses, points and all numbers of port and lens but the thickness are adjusted. The
// numbers keep near their starts: within pose::ruler_sigmas() for stated ports, and within
// usual_sigmas() for usual ports. The result has the kind that is stated first, and then the other
// kinds by increasing error. Of `options`, only the known lengths and positions are used, and of
// these only whether there are any: the length between two far images of the bundle then stays
// nearly constant.
//
// Precondition: the bundle is in metres (bring_to_metres() in refine.h). Empty if the part has
// fewer than 3 images or 20 points, if cameras have ports of several kinds, or if the adjustment
// fails for the kind that is stated. Other kinds for which it fails are left out.
std::vector<KindFit> fits_of_kinds(const pose::Bundle& bundle, const pose::AdjustOptions& options);

// The kind that fits clearly better than the first of `fits`, by six standard deviations or more.
// In addition, its error is at least 5 % smaller, or the stated port fits only with a number that
// changed by more than four standard deviations: a dome whose centre moves far behind the camera
// looks like a flat port. Nothing if there is no such kind. Of two kinds that fit better, and whose
// errors differ by less than 2 %, the one without a port counts: a dome around the camera centre
// gives the photographs of no port.
std::optional<KindFit> better_kind(const std::vector<KindFit>& fits);

}  // namespace axial::diagnosis
