// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs without water.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>
#include <variant>

#include "color/lamp_field.h"
#include "color/observations.h"
#include "color/sun_water.h"

namespace axial::color {

// What the water and the light of a survey do to the light of a surface.
using WaterModel = std::variant<SunWater, LampField>;

// The light of the surface J of I = J factor + veil. Channels that the model does not determine,
// and those of which less than a thousandth is left, are returned as they are.
Eigen::Array3f surface_light(const WaterModel& model, const Sight& sight,
                             const Eigen::Array3f& light);

// The light I = J factor + veil that the model gives for a surface.
Eigen::Array3f light_of_surface(const WaterModel& model, const Sight& sight,
                                const Eigen::Array3f& surface);

// Whether the model determines each channel, R G B.
std::array<bool, 3> determined(const WaterModel& model);

// Which light is in the photographs: `sun` or `lamp`.
enum class Light { sun, lamp };

struct Choice {
  WaterModel model;
  Light light = Light::sun;
  // spread_of() each model, of points that were not used to fit.
  double sun_spread = 0, lamp_spread = 0;
};

// Fits both models to half of the points and compares the spreads of J on the other half. Lamps are
// chosen if their spread is below 80 % of that of the sun's model, because their model has many
// more numbers. The chosen model is fitted to all points.
Choice choose_light(const Observations& observations, const Transfer& transfer);

// The fit of the model for `light`, with Choice::sun_spread and lamp_spread 0; without a light,
// choose_light().
Choice fit_light(const Observations& observations, const Transfer& transfer,
                 std::optional<Light> light);

// How much the light of one point differs between photographs, as a share of how much the light of
// different points differs (median standard deviation over a robust one), averaged over the
// channels with differences; infinity if there is none. Null model: of the photographs as they are.
double spread_of(const Observations& observations, const WaterModel* model);

// Fills way, normal and height of pixels without a way from their neighbours, from coarse to fine.
// Without any pixel that has a way nothing is filled.
void fill_sights(SightImage& sights);

// How the light of a photograph is restored and becomes values: it is divided by `exposure`, and
// the restored light is multiplied by `gain`, R G B.
struct Rendering {
  Eigen::Array3f gain = Eigen::Array3f::Ones();
  Transfer transfer;
  int bits = 8;  // 8 or 16
  Eigen::Array3f exposure = Eigen::Array3f::Ones();
};

// The gains by which the restored light of the survey is grey in the mean, and by which the
// brightest hundredth of it is at 0.7, because single pixels are brighter. 1 for channels that the
// model does not determine. An assumption, if nothing grey is known.
Eigen::Array3f grey_world(const Observations& observations, const WaterModel& model);

// A photograph without water, B G R of 8 or 16 bits. `known`: 255 where the colour is determined, 0
// where the mask is 0, where a channel of the photograph is clipped, where the pixel sees no
// surface, and where fewer than kLeastLevels grey levels (of 8 bits) are left of the light of a
// surface that becomes white.
struct Restored {
  cv::Mat pixels;
  cv::Mat1b known;
};
inline constexpr double kLeastLevels = 4;

// Restores a photograph. `light`: of light_of(), not marked; `mask`: of its size, or empty;
// `sights`: of its camera. Pixels without surface are restored as their neighbours are.
Restored restore(const cv::Mat3f& light, const cv::Mat1b& mask, SightImage sights,
                 const WaterModel& model, const Rendering& rendering);

}  // namespace axial::color
