// SPDX-License-Identifier: GPL-3.0-or-later
// The view as the fragment of the page's address, so that a link shows it to others:
// #eye=1,2,3&target=1,2,3&up=0,0,1&show=points,cameras&tab=map&layer=height&map=1,2,300
import { byId } from "./elements.js";

const GROUPS = { points: "cloud", mesh: "mesh", cameras: "cameras" };
const text = numbers => numbers.map(value => +value.toPrecision(12)).join(",");

/** The fragment of the view. `map`: the view of the map, or null. */
export function fragmentOf({ view, map, tab }) {
  const { target, up } = view.controls;
  const shown = Object.keys(GROUPS).filter(name => view[GROUPS[name]].group.visible);
  const parts = { eye: text(view.camera.position.toArray()), target: text(target.toArray()), up: text(up.toArray()),
                  show: shown.join(","), tab };
  if (map?.scale) Object.assign(parts, { layer: map.layer.id, map: text([...map.centre, map.scale]) });
  return "#" + Object.entries(parts).map(part => part.join("=")).join("&");
}

function numbersOf(parts, name, count) {
  const words = (parts.get(name) ?? "").split(","), numbers = words.map(Number);
  if (numbers.length !== count || words.includes("") || !numbers.every(Number.isFinite))
    throw new Error(`${name}=${parts.get(name) ?? ""} is not ${count} numbers`);
  return numbers;
}

function oneOf(parts, name, allowed) {
  const value = parts.get(name);
  if (!allowed.includes(value)) throw new Error(`${name}=${value} is not in this page`);
  return value;
}

/** What a fragment says. `tabs`, `layers`: names that the page has. Throws an Error that names the wrong part. */
export function readFragment(fragment, tabs, layers) {
  const parts = new Map(decodeURIComponent(fragment.slice(1)).split("&").map(part => part.split("=")));
  const [eye, target, up] = ["eye", "target", "up"].map(name => numbersOf(parts, name, 3));
  if (!Math.hypot(...up)) throw new Error("up=0,0,0 is no direction");
  if (eye.every((value, k) => value === target[k])) throw new Error("eye and target are the same place");
  const show = (parts.get("show") ?? "").split(",").filter(name => name);
  if (!show.every(name => name in GROUPS)) throw new Error(`show=${parts.get("show")} is not in this page`);
  const found = { eye, target, up, show, tab: oneOf(parts, "tab", tabs) };
  if (!parts.has("map")) return found;
  const [x, y, scale] = numbersOf(parts, "map", 3);
  if (!(scale > 0)) throw new Error(`map=${parts.get("map")} has no scale`);
  return { ...found, map: { centre: [x, y], scale }, layer: oneOf(parts, "layer", layers) };
}

/** Shows what readFragment() found. */
export function showFragment(found, { view, map, choose }) {
  for (const [name, group] of Object.entries(GROUPS)) {
    const button = byId(`show-${name}`);
    view[group].group.visible = !button.hidden && found.show.includes(name);
    button.setAttribute("aria-pressed", view[group].group.visible);
  }
  view.controls.target.fromArray(found.target);
  view.controls.up.fromArray(found.up).normalize();
  view.controls.place(view.camera.position.clone().fromArray(found.eye));
  choose(found.tab);
  if (!map || !found.map) return;
  document.querySelector(`[data-layer="${found.layer}"]`).click();
  Object.assign(map, found.map);
  map.draw();
}

/** Restores the view of the page's address, now and when it changes, and writes it there for the button "Link".
 * `parts`: view, map and choose(tab). `tab()`: the tab now. `tabs()`: the names of all tabs. */
export function startLinks(parts, tab, tabs) {
  const message = byId("link-message");
  const say = words => { message.textContent = words; message.hidden = !words; };
  const restore = () => {
    say("");
    if (location.hash.length < 2) return;
    try {
      showFragment(readFragment(location.hash, tabs(), parts.map?.map.layers.map(layer => layer.id) ?? []), parts);
    } catch (error) {
      say(`The view in the address is ignored: ${error.message}`);
    }
  };
  byId("link").onclick = () => {
    history.replaceState(null, "", fragmentOf({ ...parts, tab: tab() }));
    say("The address of the page now leads to this view.");
  };
  window.addEventListener("hashchange", restore);
  restore();
}
