// SPDX-License-Identifier: GPL-3.0-or-later
// White, by something grey or by colour charts in the photographs.
#pragma once

#include "color/observations.h"
#include "options.h"
#include "report.h"
#include "survey/survey.h"

namespace axial::apps {

// The views whose photographs Settings::grey and Settings::chart name. Error if a name is not that
// of exactly one photograph, and if the grey part lies outside the photograph.
struct WhiteViews {
  std::size_t grey = 0;
  std::vector<std::size_t> charts;  // in which charts are looked for
};
WhiteViews white_views(const Settings& settings, const survey::Survey& survey);

// Sets the gain by the grey part or by the charts, if Settings has one of them. A grey part is as
// bright as with the gain before; charts give the brightness, too: the median of their gains.
// Channels that the model does not determine keep their gain. Errors: the light of the grey part is
// not known; no photograph shows a chart; no chart has the colours of a chart.
void find_white(const Settings& settings, const survey::Survey& survey,
                const color::SeenSurface& surface, const WhiteViews& views, Findings& findings,
                const Context& context);

}  // namespace axial::apps
