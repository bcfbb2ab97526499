// SPDX-License-Identifier: GPL-3.0-or-later
// Marks picked points and paths over the picture.
import { byId, draw } from "./elements.js";

/** `screenOf(place)`: the place on the canvas [CSS px], or null behind the eye. */
export function drawOverlay(screenOf, picked, paths, keyboard, size) {
  const shapes = [];
  for (const path of paths) {
    const places = path.map(screenOf);
    if (places.every(place => place))
      shapes.push(draw("polyline", { points: places.map(place => place.join(",")).join(" ") }));
    places.forEach((place, k) => {
      if (!place) return;
      shapes.push(draw("circle", { cx: place[0], cy: place[1], r: 4 }),
                  draw("text", { x: place[0] + 8, y: place[1] - 6 }, k + 1));
    });
  }
  const at = picked && screenOf(picked);
  if (at) shapes.push(draw("circle", { cx: at[0], cy: at[1], r: 8 }));
  const [x, y] = size.map(side => side / 2);
  if (keyboard)
    shapes.push(draw("path", { class: "aim", d: `M${x - 10} ${y}h20M${x} ${y - 10}v20` }));
  byId("overlay").replaceChildren(...shapes);
}
