// SPDX-License-Identifier: GPL-3.0-or-later
// The photographs that see a point, and the list of all photographs.
import { PORTS, portOf } from "./cameras.js";
import { distance } from "./colours.js";
import { withDepthMaps } from "./depth_pictures.js";
import { byId, make, table } from "./elements.js";
import { inImage, project } from "./project.js";

/** A photograph, with a ring at the pixel if there is one. A click shows the pixel enlarged. */
function figure(camera, pixel) {
  const inner = make("span", { class: "inner" },
                     make("img", { src: camera.photo, alt: camera.name, loading: "lazy",
                                   width: camera.photo_size[0], height: camera.photo_size[1],
                                   style: "height:auto" }));
  const frame = make("button", { class: "photo", "aria-label": `Enlarge ${camera.name}` }, inner);
  if (pixel) {
    const [x, y] = pixel.map((value, k) => `${100 * (value + 0.5) / camera.size[k]}%`);
    inner.append(make("span", { class: "mark", style: `left:${x};top:${y}` }));
    inner.style.transformOrigin = `${x} ${y}`;
    frame.addEventListener("click", () => {
      const near = frame.classList.toggle("near");
      inner.style.transform = near ? "scale(5)" : "";
      inner.style.setProperty("--shrink", near ? 0.2 : 1);
    });
  }
  const place = pixel ? `${pixel[0].toFixed(1)}, ${pixel[1].toFixed(1)} px` : PORTS[portOf(camera)][0];
  return make("figure", {}, frame, make("figcaption", {}, make("span", {}, camera.name),
                                        make("span", {}, place)));
}

/** Shows the picked point: its coordinates in the world, the number of its views, its distance to the
 * true surface if that is known, and the photographs that see it. Without
 * views in the cloud, these are all photographs in whose image it lies. */
export function showPoint(scene, { position, views, error }) {
  const rows = ["x", "y", "z"].map(
    (axis, k) => [axis, (position[k] + scene.origin[k]).toFixed(4)]);
  const known = views !== null;
  if (known) rows.push(["Views", views.length]);
  if (error !== null) rows.push(["Distance to the truth", distance(error, scene)]);
  const numbers = known ? [...views] : scene.cameras.map((_, number) => number);
  const seen = numbers.map(number => [scene.cameras[number], project(scene.cameras[number], position)])
    .filter(([camera, pixel]) => inImage(camera, pixel));
  const title = `${seen.length} photograph${seen.length === 1 ? "" : "s"} ` +
    (known ? "see it" : "may show it");
  byId("point").replaceChildren(
    make("h2", {}, "Coordinates"), table(rows, "number"), make("h2", {}, title),
    ...known ? [] : [make("p", { class: "hint" }, "The cloud has no views, so hidden points are listed too.")],
    make("div", { class: "cards" }, ...seen.map(([camera, pixel]) => figure(camera, pixel))));
}

/** Lists all photographs. `look(number)` is called for the one that is chosen. */
export function listPhotographs(scene, look) {
  const chosen = make("div", { class: "cards" });
  const show = (camera, number) => chosen.replaceChildren(...withDepthMaps(
    figure(camera, null), scene.depth_maps?.[number], scene.metric ? "m" : ""));
  const buttons = scene.cameras.map((camera, number) => {
    const [port, color] = PORTS[portOf(camera)];
    return make("button", {
      onclick: () => { show(camera, number); look(number); }
    }, make("span", {}, camera.name), make("span", {
      class: "kind", style: `--color:#${color.toString(16)}`
    }, camera.port?.name || port));
  });
  byId("photographs").replaceChildren(
    make("p", { class: "hint" }, "Choose a photograph to look from its place."),
    chosen, make("h2", {}, `${buttons.length} photographs`), make("div", { class: "list" }, ...buttons));
}
