// SPDX-License-Identifier: GPL-3.0-or-later
// The tab "Map": layers with their legends, picked points, and what changed between two surveys.
import { comparison } from "./compare.js";
import { byId, make, table } from "./elements.js";
import { legendOf } from "./legend.js";
import { sceneOf } from "./map_values.js";
import { MapView } from "./maps.js";
import { quantity } from "./measure.js";
import { showProfile } from "./profile.js";

const metres = value => value === null ? "none" : `${value.toFixed(3)} m`;

/** Shows scene.map. `show(place)`: shows a place of the scene in 3D. Returns the view. */
export function startMap(scene, show) {
  const { map } = scene, points = make("div", {}), legend = make("div", { class: "legend" });
  const view = new MapView(map, place => {
    if (place) view.path.push({ place });
    else view.path.pop();
    list();
  }, () => list());
  const list = () => {
    for (const point of view.path) point.height = view.heights.at(point.place);
    points.replaceChildren(...rowsOf(view.path), ...showProfile(view.path, view.heights));
    view.draw();
    aimable();
  };
  const in3d = make("button", { id: "map-show", onclick: () => show(target(scene, view)) }, "Show in 3D");
  const aimable = () => { in3d.disabled = !target(scene, view); };
  const buttons = map.layers.map(layer => make("button", { "data-layer": layer.id, onclick: () => {
    view.choose(layer);
    buttons.forEach(button => button.setAttribute("aria-pressed", button.dataset.layer === layer.id));
    legend.replaceChildren(...legendOf(layer.legend));
  } }, layer.title));
  byId("map").replaceChildren(
    make("div", { class: "buttons", role: "group", "aria-label": "Layer" }, ...buttons), legend, ...comparison(view),
    make("h2", {}, "Points"),
    make("p", { class: "hint" }, "Click the map to add a point. Distances are horizontal." +
      (map.axes ? "" : " The files of this map do not say where it lies in 3D.")),
    make("div", { class: "buttons" },
         make("button", { onclick: () => { view.path.pop(); list(); } }, "Remove last"),
         make("button", { onclick: () => { view.path.length = 0; list(); } }, "Clear"), in3d), points,
    ...map.change ? changes(map.change, region => view.centreOn(region)) : []);
  buttons[0].click();
  aimable();
  byId("map-fit").onclick = () => view.fit();
  byId("map-larger").onclick = () => view.zoom(1.5);
  byId("map-smaller").onclick = () => view.zoom(1 / 1.5);
  return view;
}

// The last point in 3D, or null.
function target(scene, view) {
  const last = view.path.at(-1);
  return last ? sceneOf(scene.map, last.place, last.height, scene.origin) : null;
}

function rowsOf(path) {
  if (!path.length) return [];
  const rows = path.map(({ place, height }, k) => [k + 1, ...place.map(value => value.toFixed(3)),
                                                   height === null ? "none" : height.toFixed(3)]);
  const parts = path.slice(1).map((point, k) => {
    const [from, to] = [path[k], point];
    const rise = from.height === null || to.height === null ? null : to.height - from.height;
    return [`${k + 1} to ${k + 2}`, Math.hypot(...to.place.map((value, i) => value - from.place[i])), rise];
  });
  const rises = parts.map(part => part[2]);
  if (parts.length > 1)
    parts.push(["Path", parts.reduce((sum, part) => sum + part[1], 0),
                rises.includes(null) ? null : rises.reduce((sum, value) => sum + value, 0)]);
  const headed = (heads, body) => make(
    "table", { class: "grid" }, make("tr", {}, ...heads.map(head => make("th", { scope: "col" }, head))),
    ...body.map(cells => make("tr", {}, ...cells.map(cell => make("td", { class: "number" }, String(cell))))));
  return [headed(["", "x [m]", "y [m]", "height [m]"], rows),
          ...parts.length ? [headed(["", "distance", "rise"],
                                    parts.map(([name, long, rise]) => [name, metres(long), metres(rise)]))] : []];
}

const volumeText = ({ volume, volume_sigma: sigma }) => {
  const small = Math.abs(volume) < 0.001;
  const [factor, unit, digits] = small ? [1e6, "cm³", 1] : [1, "m³", 6];
  return `${(factor * volume).toFixed(digits)} ± ${(factor * sigma).toFixed(digits)} ${unit}`;
};

function changes(change, centre) {
  const share = part => `${quantity(part.area, "m", 2)} (${(100 * part.area / (change.area_compared || 1)).toFixed(2)} %)`;
  const regions = change.regions.map((region, k) => make("button", {
    onclick: () => centre(region), "data-region": k
  }, make("span", { class: "kind", style: `--color:${region.change === "came" ? "#4282be" : "#e67832"}` },
          region.change), make("span", {}, volumeText(region))));
  const more = change.of_regions - change.regions.length;
  return [
    make("h2", {}, "Changes"),
    make("p", { class: "hint" }, `From ${change.before} to ${change.after}, on ${quantity(change.area_compared, "m", 2)}. ` +
      "± is one standard deviation."),
    table([["Came", volumeText(change.came)], ["", share(change.came)], ["Gone", volumeText(change.gone)],
           ["", share(change.gone)], ["Net", volumeText(change.net)]], "number"),
    make("h2", {}, regions.length ? "Largest regions" : "No region changed"),
    make("div", { class: "list" }, ...regions),
    ...more > 0 ? [make("p", { class: "hint" }, `${more} smaller regions are not listed.`)] : []];
}
