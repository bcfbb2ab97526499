// SPDX-License-Identifier: GPL-3.0-or-later
// A switch that shows the depth map of a photograph in its place.
import { make } from "./elements.js";
import { legendOf } from "./legend.js";

const TITLES = { photograph: "Photograph", depth: "Depth", normal: "Normal", confidence: "Confidence" };
const HINTS = {
  depth: "Distance along the line of sight. Dark places have no depth.",
  normal: "Direction of the surface: red to the right, green upwards, blue to the camera.",
  confidence: "Higher is better."
};

/** The elements to show for a photograph: its `figure`, and a switch if it has a depth map. `maps`:
 * its entry of scene.depth_maps. `unit`: of depths. */
export function withDepthMaps(figure, maps, unit) {
  if (!maps) return [figure];
  const image = figure.querySelector("img"), photograph = image.src;
  const text = make("p", { class: "hint" }), legend = make("div", { class: "legend" });
  const kinds = ["photograph", "depth", "normal", "confidence"].filter(kind => kind === "photograph" || maps[kind]);
  const buttons = kinds.map(kind => make("button", { "data-depth": kind, onclick: () => choose(kind) },
                                         TITLES[kind]));
  const choose = kind => {
    const map = maps[kind];
    image.src = map ? map.file : photograph;
    buttons.forEach(button => button.setAttribute("aria-pressed", button.dataset.depth === kind));
    legend.replaceChildren(...map?.colors ? legendOf({ ...map, unit: kind === "depth" ? unit : "" }) : []);
    text.textContent = HINTS[kind] ?? "";
  };
  choose("photograph");
  return [figure, make("div", { class: "buttons depth", role: "group", "aria-label": "Picture" }, ...buttons),
          legend, text];
}
