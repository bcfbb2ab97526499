// SPDX-License-Identifier: GPL-3.0-or-later
// The experiments that reconstruct simulated scenes with the project's programs and COLMAP
// (chain.h).
#pragma once

#include "experiments/chain.h"
#include "experiments/experiment.h"

namespace axial::experiments {

// Each function reads the programs of the chain, whose fingerprints belong to the inputs of the
// parts. The parts run the programs, and throw an Error if a program fails. `chain.work` belongs to
// the experiment alone: its parts replace and remove folders there. `quick`: few views and small
// images, for tests.

// The paper's figures 5 and 6: a scene reconstructed in air and through a port, with the paper's
// method, with our method, and with one half (projection or warp) of each.
Experiment reconstruction(const Chain& chain, bool quick);

// Clouds on true poses, with housing files that differ from the true port.
Experiment sensitivity(const Chain& chain, bool quick);

// Where a refractive model is needed: a known port on true poses, beside a lens that COLMAP
// calibrates under water and a pinhole engine uses.
Experiment need(const Chain& chain, bool quick);

}  // namespace axial::experiments
