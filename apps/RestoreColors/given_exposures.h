// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "color/exposure.h"
#include "survey/survey.h"

namespace axial::apps {

// The exposures of the views' photographs, from a file of io::read_photograph_numbers() with the
// column "exposure". A name in the file is the end of the path of a photograph; lines of other
// photographs are not used. Error that names the file and the photograph if a view has no exposure
// or several, or if an exposure is not above 0.
color::Exposures given_exposures(const std::filesystem::path& file, const survey::Survey& survey);

}  // namespace axial::apps
