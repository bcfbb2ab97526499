// SPDX-License-Identifier: GPL-3.0-or-later
// The viewer of a folder that ViewScene wrote.
import { loadAll, loadScene } from "./data.js";
import { Colours } from "./colours.js";
import { byId, make, table } from "./elements.js";
import { drawOverlay } from "./overlay.js";
import { startLinks } from "./link.js";
import { Paths } from "./paths.js";
import { listPhotographs, showPoint } from "./photographs.js";
import { largestError } from "./project.js";
import { Residuals } from "./residuals.js";
import { showStage, startSurvey } from "./survey.js";
import { View } from "./view.js";

const state = { tab: "point", picked: null, keyboard: false };
const count = value => value.toLocaleString("en-US");

// The buttons of the tabs that this scene has.
const tabs = () => [...document.querySelectorAll("nav [data-tab]:not([hidden])")];

function choose(tab) {
  state.tab = tab;
  for (const button of tabs()) {
    button.setAttribute("aria-selected", button.dataset.tab === tab);
    byId(button.dataset.tab).hidden = button.dataset.tab !== tab;
  }
  showStage(tab);
}

function toggle(id, group, view) {
  const button = byId(id);
  button.setAttribute("aria-pressed", group.visible);
  button.onclick = () => {
    group.visible = !group.visible;
    button.setAttribute("aria-pressed", group.visible);
    view.move();
  };
}

function about(scene) {
  const checks = scene.cameras.reduce((sum, camera) => sum + camera.check.length, 0);
  const error = Math.max(0, ...scene.cameras.map(largestError));
  const keys = [["Mouse", "drag to turn, right button or Shift to move, wheel to zoom"],
                ["Touch", "one finger turns, two fingers move and zoom, a tap picks"],
                ["Arrows", "turn; with Shift: move"], ["+ and −", "zoom"],
                ["Enter", "pick the point in the middle"], ["Backspace", "remove the last point of a path"],
                ["1, 2, …", "choose a tab"], ["R", "reset the view"]];
  byId("about").replaceChildren(
    make("h2", {}, "Reconstruction"),
    table([["Scene", scene.files.scene],
           ...scene.files.cloud ? [["Cloud", scene.files.cloud]] : [],
           ...scene.files.mesh ? [["Mesh", scene.files.mesh]] : [],
           ...scene.files.cloud ? [["Points", `${count(scene.points)} of ${count(scene.all_points)}`]] : [],
           ["Photographs", scene.cameras.length],
           ["Unit", scene.metric ? "metre" : "not known (no port)"],
           ["Written by", scene.program]]),
    make("h2", {}, "Projection"),
    make("p", { id: "projection" }, checks ? "The pixels of this page agree with AxialMVS to " +
      `${error.toExponential(1)} px (${count(checks)} points).` :
      `Not checked: ${scene.files.cloud ? "the cloud has no views" : "there is no cloud"}.`),
    make("h2", {}, "Keys"), table(keys));
}

// Without a cloud there are no points to show, to colour or to enlarge; the mesh is picked.
function showMeshAlone(view) {
  view.cloud.group.visible = false;
  view.mesh.group.visible = true;
  for (const id of ["show-points", "colours", "larger", "smaller"]) byId(id).hidden = true;
}

function start(scene) {
  let paths = null, view = null;
  const pick = (x, y) => {
    const point = view.pick(x, y);
    if (!point) return;
    if (state.tab === "measure") return paths.add(point.position);
    state.picked = point.position;
    if (state.tab !== "point") choose("point");
    showPoint(scene, point);
    view.drawn();
  };
  const overlay = () => drawOverlay(place => view.screenOf(place), state.picked,
                                    paths ? paths.all : [], state.keyboard, view.size);
  view = new View(scene, pick, overlay);
  paths = new Paths(scene, view.mesh, () => view.drawn());
  if (!scene.files.cloud) showMeshAlone(view);
  toggle("show-points", view.cloud.group, view);
  toggle("show-cameras", view.cameras.group, view);
  toggle("show-mesh", view.mesh.group, view);
  byId("show-mesh").hidden = !scene.mesh;
  const resize = factor => () => {
    view.pointSize = Math.min(Math.max(view.pointSize * factor, 1), 16);
    view.move();
  };
  byId("larger").onclick = resize(1.4);
  byId("smaller").onclick = resize(1 / 1.4);
  byId("reset").onclick = () => { view.cameras.choose(-1); view.reset(); };
  for (const button of document.querySelectorAll("nav [data-tab]"))
    button.onclick = () => choose(button.dataset.tab);
  listKeys(view, paths, pick);
  listPhotographs(scene, number => view.lookFrom(scene.cameras[number], number));
  const map = startSurvey(scene, place => {
    choose("point");
    state.picked = place;
    showPoint(scene, { position: place, error: null, views: view.cloud.nearest(place)?.views ?? null });
    view.lookAt(place);
  });
  about(scene);
  const colours = new Colours(scene, view.cloud, () => view.move());
  document.querySelector("[data-tab=residuals]").hidden = !scene.residuals;
  const residuals = scene.residuals ? new Residuals(scene) : null;
  startLinks({ view, map, choose }, () => state.tab, () => tabs().map(button => button.dataset.tab));
  return { view, paths, map, colours, residuals };
}

function listKeys(view, paths, pick) {
  const aim = keyboard => {
    state.keyboard = keyboard;
    view.canvas.classList.toggle("keyboard", keyboard);
    view.drawn();
  };
  view.canvas.addEventListener("blur", () => aim(false));
  view.canvas.addEventListener("pointerdown", () => aim(false));
  view.canvas.addEventListener("keydown", event => {
    aim(true);
    if (event.key === "Enter") pick(view.size[0] / 2, view.size[1] / 2);
    if (event.key === "Backspace") paths.removeLast();
    if (event.key.toLowerCase() === "r") byId("reset").click();
  });
  document.addEventListener("keydown", event => {
    const tab = tabs()[event.key - 1];
    const writing = event.target instanceof HTMLSelectElement;
    if (tab && !writing && !event.ctrlKey && !event.altKey && !event.metaKey) choose(tab.dataset.tab);
  });
}

async function load(scene, { view, paths, map, colours }) {
  await loadAll("cloud", scene.chunks, (entry, bytes) => {
    colours.paint(view.cloud.add(entry, bytes));
    byId("status").textContent = `${count(view.cloud.points)} of ${count(scene.points)} points`;
    view.move();
  });
  if (scene.mesh) {
    byId("status").textContent = "Loading the mesh…";
    const images = [];
    await loadAll("texture", scene.mesh.textures, (entry, bytes) => images.push(bytes));
    for (const image of images) await view.mesh.addTexture(image);
    await loadAll("mesh", scene.mesh.parts, (entry, bytes) => view.mesh.add(entry, bytes));
    paths.meshLoaded();
    view.move();
  }
  await map?.load();
  const faces = scene.mesh ? scene.mesh.parts.reduce((sum, part) => sum + part.faces, 0) : 0;
  byId("status").textContent = scene.files.cloud ? `${count(view.cloud.points)} points`
                                                 : `${count(faces)} faces`;
}

function report(error) {
  byId("status").className = "error";
  byId("status").textContent = error.message;
  console.error(error);
}

async function run() {
  const scene = await loadScene();
  document.title = scene.files.scene;
  const parts = start(scene);
  globalThis.axial = { scene, ...parts, state, ready: false }; // for tests
  try {
    await load(scene, parts);
    globalThis.axial.ready = true;
  } finally {
    parts.view.rest(); // what could be loaded is drawn in full
  }
}

run().catch(report);
