// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "densify/existing_maps.h"
#include "densify/memory_plan.h"
#include "densify/project.h"
#include "survey/image_store.h"

namespace axial::densify {

// What the stages of a run share. The referenced objects must outlive it.
struct Run {
  const Project& project;
  const ExistingMaps& existing;  // the result of find_existing_maps()
  const MemoryPlan& plan;
  survey::ImageStore& images;
  const Context& context;
};

}  // namespace axial::densify
