// SPDX-License-Identifier: GPL-3.0-or-later
// The experiments that reconstruct simulated scenes with the project's programs and COLMAP
// (chain.h).
#pragma once

#include "experiments/chain.h"
#include "experiments/experiment.h"

namespace axial::experiments {

// The three functions below return an experiment. They read the programs of the chain, because the
// inputs of the parts contain the fingerprints of the programs. Error if a program cannot be read.
// Part::compute runs the programs, and throws an Error if a program fails. No other experiment may
// use `chain.work`, because the parts replace and remove folders in `chain.work`. `quick`: fewer
// parts with few views and small images, for tests.

// The paper's figures 5 and 6. A scene is reconstructed in air and through a port. The methods
// through the port are the paper's method, our method, the paper's projection with our warp, and
// the paper's warp with our projection.
Experiment reconstruction(const Chain& chain, bool quick);

// The effect of a wrong port. The clouds are computed on true poses, with housing files that differ
// from the true port in at most one parameter.
Experiment sensitivity(const Chain& chain, bool quick);

// Shows where a refractive model is needed. Compares two reconstructions of each scene. The first
// uses the known port and true poses. The second uses no port, COLMAP's poses, and a lens that
// COLMAP calibrates under water.
Experiment need(const Chain& chain, bool quick);

}  // namespace axial::experiments
