// SPDX-License-Identifier: GPL-3.0-or-later
// Converts a COLMAP model of photographs taken through a port to a bundle, and back.
#pragma once

#include <span>

#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "pose/adjust/uncertainty.h"
#include "pose/bundle/adjust_options.h"

namespace axial::pose {

// A bundle, and the parts of a COLMAP model that the bundle itself does not hold.
struct ColmapBundle {
  Bundle bundle;
  std::vector<io::ColmapCamera> lenses;  // per bundle camera: its lens in air; ids count from 1
  std::vector<std::string> ports;        // per bundle camera: the name of its port, or "none"
  std::size_t unseen = 0;  // observations left out because the lens has no direction for the pixel
};

// Makes a bundle from the poses, points and tracks of `model`. The lenses of `model` are not used.
// `lenses` holds lenses calibrated in air: if `lenses` has exactly one entry, all cameras of
// `model` get this lens. Otherwise each camera gets the lens with its own id. `housing` gives the
// port of each image. The bundle has one camera for each pair of lens and port that occurs. Cameras
// behind one port whose lenses are the same but for the size of the photographs (focal lengths, or
// focal lengths by the width, that differ by at most 0.1 %) share their change
// (BundleCamera::same_as). Its images and points have the order of `model`. Observations whose
// pixel has no direction in the lens are left out. The frame and the unit of `model` are kept;
// adjust() needs metres.
//
// Throws an Error if a camera of an image has no lens, if the image sizes of a camera and its lens
// differ, if the model of a lens is not supported, if a port is not defined, or if a camera is
// behind a water surface.
//
// The standard deviations of `lenses` and `housing` become BundleCamera::stated_sigma.
ColmapBundle to_bundle(const io::ColmapModel& model, std::span<const io::ColmapCamera> lenses,
                       const io::Housing& housing);

// Two RMS reprojection errors [px] of the tracks of a model: with its cameras behind their ports
// (ColmapCamera::port), and with the same cameras in air. The smaller error belongs to the cameras
// with which the poses were computed. Both are 0 if the model has no tracks.
struct PortFit {
  double behind_ports = 0, in_air = 0;
};

// Returns these two errors for `model`, at its poses and points. Of several observations of a point
// in one image, the one with the smallest error counts. Errors as for to_bundle().
PortFit port_fit(const io::ColmapModel& model);

// Converts a bundle back. `model` is the model from which to_bundle() made the bundle. Points and
// observations may have been dropped since, but the images must be the same in the same order. The
// result has the poses, points, tracks and mean reprojection errors [px] of the bundle. It has one
// camera for each camera of the bundle, with the present lens in air, the present port and the id
// of ColmapBundle::lenses. Images without observations are left out. `sigmas`: the present standard
// deviations of the numbers of each camera, as in present_sigmas(); empty: none are stated.
io::ColmapModel to_model(const ColmapBundle& bundle, const io::ColmapModel& model,
                         std::span<const HousingChange<double>> sigmas = {});

// The cameras of to_model().
std::vector<io::ColmapCamera> refined_cameras(const ColmapBundle& bundle,
                                              std::span<const HousingChange<double>> sigmas);

// The present ports of the bundle, as a housing for the camera ids of ColmapBundle::lenses.
// `measured` is the housing from which the bundle was made. If several cameras share a port, each
// camera whose numbers have changed gets a port of its own, with the exception of cameras with
// BundleCamera::same_as. The name of this port is the old name,
// an underscore and the camera id. Exception: if all cameras have one and the same port and
// `measured` has no entries by image, this port becomes the default port, and there are no entries
// by camera. `sigmas`: as for to_model().
io::Housing to_housing(const ColmapBundle& bundle, const io::Housing& measured,
                       std::span<const HousingChange<double>> sigmas = {});

// The standard deviations that `lens`, and `housing` for its port `port`, state, in the units of
// housing_change.h; 0: not stated.
HousingChange<double> stated_sigma(const io::ColmapCamera& lens, const io::Housing& housing,
                                   const std::string& port);

// The standard deviations `sigma`, in the units of housing_change.h, as those of `port` in a
// housing file. Of the components of a normal or of a centre, all or none are stated.
io::PortSigmas port_sigmas(const refractive::Port<double>& port,
                           const HousingChange<double>& sigma);

// The standard deviations that files of the refined cameras state for the numbers of each camera of
// `bundle`, in the units of housing_change.h; 0: none is stated. Numbers that are not free keep
// BundleCamera::stated_sigma. Free numbers have the standard deviations of `known`. They have none
// without `known` (null), or if their standard deviation is above 1. The index of the water, if it
// is free, has none, because it belongs to the water of one dive and not to the housing.
std::vector<HousingChange<double>> present_sigmas(const Bundle& bundle,
                                                  const AdjustOptions& options,
                                                  const Uncertainty* known);

}  // namespace axial::pose
