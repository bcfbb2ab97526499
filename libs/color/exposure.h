// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs of different exposure or white balance: their light is e (J factor + veil), with a
// number e for each photograph and channel.
#pragma once

#include <span>
#include <vector>

#include "color/restore.h"

namespace axial::color {

// By view, R G B. The geometric mean of each channel is 1.
using Exposures = std::vector<Eigen::Array3f>;

// Exposures with these ratios, above 0, by view: the same in all channels.
Exposures exposures_of(std::span<const double> ratios);

// Exposures by the light of common points alone. Differences of the distances are taken for
// exposures; a start for exposures_by().
Exposures even_exposures(const Observations& observations, std::size_t views);

// Exposures by a model: medians of the light over that which the model gives for J of the point, by
// its other observations. 1 for photographs with fewer than 30 observations, and in channels that
// the model does not determine.
Exposures exposures_by(const WaterModel& model, const Observations& observations,
                       std::size_t views);

// The model, and the exposures by which `even` is divided: they are estimated in turn.
struct Evened {
  Choice choice;
  Exposures exposures;
  Observations even;
};
Evened fit_exposures(const Observations& observations, std::size_t views, const Transfer& transfer,
                     std::optional<Light> light);

// The observations with their light divided by the exposures of their photographs.
Observations divided_by(const Exposures& exposures, Observations observations);

// How much exposures differ: the largest robust standard deviation of the logarithms of a channel.
double difference_of(const Exposures& exposures);

}  // namespace axial::color
