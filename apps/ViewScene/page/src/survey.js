// SPDX-License-Identifier: GPL-3.0-or-later
// The tabs "Map", "Colours" and "Run", which a folder has if ViewScene was given their files.
import { byId } from "./elements.js";
import { startMap } from "./map_panel.js";
import { showRestored } from "./restored.js";
import { showRun } from "./run.js";

let map = null;
const tabOf = name => document.querySelector(`nav [data-tab=${name}]`);

/** `show(place)`: shows a place of the scene in 3D. Returns the view of the map, or null. */
export function startSurvey(scene, show) {
  if (scene.run) {
    tabOf("run").hidden = false;
    showRun(scene.run);
  }
  if (scene.colors) {
    tabOf("restored").hidden = false;
    showRestored(scene.colors);
  }
  if (!scene.map) return null;
  tabOf("map").hidden = false;
  map = startMap(scene, show);
  return map;
}

/** To be called when a tab is chosen: the map covers the 3D view, which then has no keyboard focus. */
export function showStage(tab) {
  byId("map-stage").hidden = tab !== "map";
  for (const id of ["canvas", "toolbar"]) byId(id).inert = tab === "map";
  map?.resize();
}
