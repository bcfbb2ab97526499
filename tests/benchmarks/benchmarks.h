// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace axial::benchmarks {

void add_scorer_benchmarks();
void add_matching_benchmarks();

}  // namespace axial::benchmarks
