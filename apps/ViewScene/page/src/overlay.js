// SPDX-License-Identifier: GPL-3.0-or-later
// Marks picked points and paths over the picture.
import { byId } from "./elements.js";

function shape(name, attributes, text = "") {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.textContent = text;
  return element;
}

/** `screenOf(place)`: the place on the canvas [CSS px], or null behind the eye. */
export function drawOverlay(screenOf, picked, paths, keyboard, size) {
  const shapes = [];
  for (const path of paths) {
    const places = path.map(screenOf);
    if (places.every(place => place))
      shapes.push(shape("polyline", { points: places.map(place => place.join(",")).join(" ") }));
    places.forEach((place, k) => {
      if (!place) return;
      shapes.push(shape("circle", { cx: place[0], cy: place[1], r: 4 }),
                  shape("text", { x: place[0] + 8, y: place[1] - 6 }, k + 1));
    });
  }
  const at = picked && screenOf(picked);
  if (at) shapes.push(shape("circle", { cx: at[0], cy: at[1], r: 8 }));
  const [x, y] = size.map(side => side / 2);
  if (keyboard)
    shapes.push(shape("path", { class: "aim", d: `M${x - 10} ${y}h20M${x} ${y - 10}v20` }));
  byId("overlay").replaceChildren(...shapes);
}
