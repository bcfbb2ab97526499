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

// The relief of a survey is its height, averaged over cells of at least 1/60 of the longer side of
// the map, minus the mean of the cells around, over 0.07 of the map. Large heights are cut off at
// three robust standard deviations. A correlation here is the median of the correlations in windows
// of 6 x 6 cells: ground that did not change decides if it is more than half of the map, however
// large the changes are.
struct PlaceAgreement {
  PlaceVerdict verdict = PlaceVerdict::unknown;
  // Correlation of the reliefs of both surveys: 1 for the same ground, about 0 for different
  // places.
  double correlation = 0;
  // The correlation below which the places are different: the smaller one of 0.6 and of 2.5 times
  // `relief`.
  double least = 0;
  // Correlation by chance: the value that one in a hundred correlations exceeds if the later map is
  // shifted, turned by half a turn or mirrored.
  double chance = 0;
  // Correlation of the reliefs with themselves one cell away: the geometric mean of both surveys.
  // Ground has about 0.24 to 0.8, and the noise of reconstructions of level ground at most 0.13.
  // Below 0.2 the verdict is `unknown`, unless `correlation` is 0.6 or more.
  double relief = 0;
};

// Measured on reconstructions of the presets of SimulateUnderwater, with and without registration:
// the same ground in air and under water, also with a tenth of the faces, has a correlation of 0.87
// or more. Smooth ground of which a boulder left a ninth, with a noise of 3 mm, has 0.69. Different
// seeds of a preset have at most 0.52, but for one pair of 48 with 0.63. The largest values are
// those of thicket and closeup, whose large objects have similar places for all seeds.
//
// Compares the heights of two surveys at the same pixels. NaN: no height. The maps have the same
// size. The result does not depend on the number of threads.
PlaceAgreement agreement_of_places(const cv::Mat1f& before, const cv::Mat1f& after);

}  // namespace axial::compare
