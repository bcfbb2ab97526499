// SPDX-License-Identifier: GPL-3.0-or-later
// The survey that a call of Python passes to a stage: files, or a scene in memory.
#pragma once

#include <initializer_list>

#include "axial/survey.h"
#include "src/keywords.h"

namespace axial::python {

struct SurveyCall {
  py::object scene;        // a path, or the fields of a scene in memory
  py::object photographs;  // of a scene in memory: function of the index of an image
  py::object masks;        // the same, or None

  bool in_memory() const { return py::isinstance<py::dict>(scene); }
};

// The scene of `call`, which is in memory, in the world. `call` must outlive the result.
survey::MemorySurvey memory_survey(const SurveyCall& call);

// Sets the files of the scene, with its folder as the working folder unless one is set.
void take_files(const SurveyCall& call, survey::Options& options);

// Sets the files of the scene, or its data in memory, for a stage whose keywords are `keywords`.
// `call` must outlive the survey. Errors as for refuse_in_memory().
void take_survey(const SurveyCall& call, const py::dict& keywords, survey::Options& options);

// Adds the keywords of the survey, except the paths of the scene.
void add_survey_keywords(Keywords& keywords, survey::Options& options);

// Throws an Error that names the first of the keywords that a scene in memory does not have: those
// of the files of a scene, and `more`.
void refuse_in_memory(const py::dict& keywords, std::initializer_list<const char*> more = {});

// As for the programs: a folder of masks is given to be used, with the label 0.
void use_given_masks(const py::dict& keywords, survey::Options& options);

}  // namespace axial::python
