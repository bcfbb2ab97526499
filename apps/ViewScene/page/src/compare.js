// SPDX-License-Identifier: GPL-3.0-or-later
// A slider between two layers of the map: the second one covers the part on the right of a line.
import { byId, make } from "./elements.js";

/** Elements that choose the second layer of the MapView `view` and move the line. */
export function comparison(view) {
  const slider = byId("map-slider"), { layers } = view.map;
  slider.value = 100 * view.cut; // a reloaded page may have kept another value
  const choice = make("select", { id: "map-compare", "aria-label": "Layer on the right" },
                      make("option", { value: "" }, "no other layer"),
                      ...layers.map(layer => make("option", { value: layer.id }, layer.title)));
  choice.onchange = () => {
    view.other = layers.find(layer => layer.id === choice.value) ?? null;
    slider.hidden = !view.other;
    view.draw();
  };
  slider.oninput = () => { view.cut = slider.value / 100; view.draw(); };
  return layers.length > 1 ? [make("label", { class: "choice" }, "Compare with ", choice)] : [];
}
