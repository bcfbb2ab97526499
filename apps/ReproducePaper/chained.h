// SPDX-License-Identifier: GPL-3.0-or-later
// The experiments that reconstruct simulated scenes with the project's programs and COLMAP.
#pragma once

#include "chain.h"
#include "experiments/experiment.h"

namespace axial {

// `chain.work` belongs to the experiment alone. `quick`: few views and small images, for tests.
experiments::Experiment reconstruction(const Chain& chain, bool quick);  // figures 5 and 6
experiments::Experiment sensitivity(const Chain& chain, bool quick);     // to wrong housing files
experiments::Experiment need(const Chain& chain, bool quick);            // of a refractive model

// Cells of the experiments' tables.
std::string millimetres(const Json& metres);  // "0.871"; "-" for null
std::string percent(const Json& fraction);    // "74.2"; "-" for null

}  // namespace axial
