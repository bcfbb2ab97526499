// SPDX-License-Identifier: GPL-3.0-or-later
// Whether two surveys show the same place.
#pragma once

#include <opencv2/core.hpp>

namespace axial::compare {

// What the heights of two surveys tell about the places that they show.
enum class PlaceVerdict {
  same,       // the reliefs agree
  different,  // both surveys have relief, and the reliefs do not agree
  unknown     // there is too little relief, or too few common pixels
};

// The relief of a survey is its height, averaged over cells of at least 1/40 of the longer side of
// the map, minus the mean of the cells around, over a tenth of the map. Large heights are cut off
// at three robust standard deviations, so that few rocks that moved do not decide.
struct PlaceAgreement {
  PlaceVerdict verdict = PlaceVerdict::unknown;
  // Correlation of the reliefs of both surveys: 1 for the same ground, about 0 for different
  // places.
  double correlation = 0;
  // The correlation below which the places are different: the smaller one of 0.55 and of 2.5 times
  // `relief`.
  double least = 0;
  // Correlation by chance: the value that one in a hundred correlations exceeds if the later map is
  // shifted, turned by half a turn or mirrored.
  double chance = 0;
  // Correlation of the reliefs with themselves one cell away: the geometric mean of both surveys.
  // Ground has about 0.2 to 0.6, the noise of reconstructions of level ground at most 0.07. Below
  // 0.1 the verdict is `unknown`, unless `correlation` is 0.55 or more.
  double relief = 0;
};

// Measured on reconstructions of the presets of SimulateUnderwater, with and without registration:
// the same ground in air and under water, behind other ports, in haze, with a moved boulder, and
// with a tenth of the faces has a correlation of 0.88 or more, and level ground on which a large
// block moved 0.67. Different seeds of a preset have at most 0.45. Exception: thicket, whose stems
// have places of their own, has up to 0.66 before the registration, and 0.4 after it.
//
// Compares the heights of two surveys at the same pixels. NaN: no height. The maps have the same
// size. The result does not depend on the number of threads.
PlaceAgreement agreement_of_places(const cv::Mat1f& before, const cv::Mat1f& after);

}  // namespace axial::compare
