// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of the tab "Map": layers on one plane, moved and zoomed with mouse, touch and keyboard.
// Places are [x, y] of the map [m].
import { loadAll } from "./data.js";
import { byId } from "./elements.js";
import { Heights, scaleBar } from "./map_values.js";

const STEPS = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const PIXELS_WHEN_NEAR = 3; // from this size on, pixels of a layer are drawn as squares

export class MapView {
  /** `map`: its part of data/scene.js. `picked(place)`: called for a click or a tap, and with null to
   * remove the last place. `loaded()`: called when the heights are loaded. */
  constructor(map, picked, loaded) {
    Object.assign(this, { map, picked, loaded, path: [], region: null, other: null, cut: 0.5,
                          pointers: new Map(), travelled: 0 });
    this.canvas = byId("map-canvas");
    this.images = new Map();
    this.heights = new Heights(null, null);
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    this.choose(map.layers[0]);
  }

  async load() {
    if (!this.map.heights) return;
    await loadAll("heights", [this.map.heights], (entry, bytes) => {
      this.heights = new Heights(entry, bytes);
    });
    this.loaded();
  }

  /** Shows a layer of the map. */
  choose(layer) {
    this.layer = layer;
    this.draw();
  }

  /** The picture of a layer, which is loaded when it is first drawn; null until then. */
  imageOf(layer) {
    let image = this.images.get(layer.id);
    if (!image) {
      image = new Image();
      image.onload = () => this.draw();
      image.onerror = () => console.error(`${image.src} cannot be read`);
      image.src = layer.file;
      this.images.set(layer.id, image);
    }
    return image.complete && image.naturalWidth ? image : null;
  }

  get image() { return this.imageOf(this.layer); }

  get size() { return [this.canvas.clientWidth, this.canvas.clientHeight]; }

  resize() {
    const [width, height] = this.size;
    if (!width || !height) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    if (!this.scale) this.fit();
    this.draw();
  }

  /** Shows the whole layer. */
  fit() {
    const [left, top, width, height] = this.layer.place, [across, down] = this.size;
    this.centre = [left + width / 2, top - height / 2];
    this.scale = 0.94 * Math.min(across / width, down / height); // [CSS px / m]
    this.region = null;
    this.draw();
  }

  /** Shows a region of change in the middle. */
  centreOn(region) {
    this.region = region;
    this.centre = [region.x, region.y];
    const side = Math.max(Math.sqrt(region.area), this.layer.place[2] / this.layer.size[0]);
    this.scale = Math.min(...this.size) / (6 * side);
    this.draw();
  }

  screenOf([x, y]) {
    const [width, height] = this.size;
    return [(x - this.centre[0]) * this.scale + width / 2,
            (this.centre[1] - y) * this.scale + height / 2];
  }

  placeOf(u, v) {
    const [width, height] = this.size;
    return [this.centre[0] + (u - width / 2) / this.scale,
            this.centre[1] - (v - height / 2) / this.scale];
  }

  pan(dx, dy) {
    this.centre = [this.centre[0] - dx / this.scale, this.centre[1] + dy / this.scale];
    this.draw();
  }

  /** Zooms in by `factor`. The place at (u, v) stays where it is. */
  zoom(factor, u = this.size[0] / 2, v = this.size[1] / 2) {
    const before = this.placeOf(u, v), [, , width, height] = this.layer.place;
    const least = 0.2 * Math.min(this.size[0] / width, this.size[1] / height);
    const most = 60 * this.layer.size[0] / width;
    this.scale = Math.min(Math.max(this.scale * factor, least), Math.max(most, least));
    const after = this.placeOf(u, v);
    this.centre = this.centre.map((value, k) => value + before[k] - after[k]);
    this.draw();
  }

  listen() {
    const { canvas, pointers } = this;
    const middle = () => [0, 1].map(
      k => [...pointers.values()].reduce((sum, place) => sum + place[k], 0) / pointers.size);
    const spread = () => {
      const [a, b] = pointers.values();
      return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
    };
    canvas.addEventListener("pointerdown", event => {
      canvas.setPointerCapture(event.pointerId);
      canvas.focus({ preventScroll: true });
      if (!pointers.size) this.travelled = 0;
      pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
      this.aim(false);
    });
    canvas.addEventListener("pointermove", event => {
      this.tell(event.offsetX, event.offsetY);
      if (!pointers.has(event.pointerId)) return;
      const from = middle(), apart = spread();
      pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
      const to = middle();
      this.travelled += Math.hypot(to[0] - from[0], to[1] - from[1]);
      this.pan(to[0] - from[0], to[1] - from[1]);
      if (apart > 0) this.zoom(spread() / apart, ...to);
    });
    for (const name of ["pointerup", "pointercancel"])
      canvas.addEventListener(name, event => this.release(event));
    canvas.addEventListener("wheel", event => {
      event.preventDefault();
      const notches = Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100);
      this.zoom(Math.exp(-0.002 * notches), event.offsetX, event.offsetY);
    }, { passive: false });
    // Browsers do not report the release of the button to a page behind a menu.
    canvas.addEventListener("contextmenu", event => event.preventDefault());
    canvas.addEventListener("blur", () => this.aim(false));
    canvas.addEventListener("keydown", event => this.key(event));
  }

  release(event) {
    const single = this.pointers.size === 1;
    if (!this.pointers.delete(event.pointerId)) return;
    if (!single) this.travelled = Infinity; // the end of a gesture is no tap
    if (event.type !== "pointerup" || !single || this.travelled >= 6 || event.button !== 0) return;
    this.tell(event.offsetX, event.offsetY); // a tap comes without a move
    this.picked(this.placeOf(event.offsetX, event.offsetY));
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const step = STEPS[event.key], [width, height] = this.size;
    if (step) this.pan(40 * step[0], 40 * step[1]);
    else if (event.key === "+" || event.key === "=") this.zoom(1.25);
    else if (event.key === "-") this.zoom(0.8);
    else if (event.key.toLowerCase() === "r") this.fit();
    else if (event.key === "Enter") this.picked(this.placeOf(width / 2, height / 2));
    else if (event.key === "Backspace") this.picked(null);
    else return;
    event.preventDefault();
    this.aim(true);
    this.tell(width / 2, height / 2);
  }

  aim(keyboard) {
    this.keyboard = keyboard;
    this.canvas.classList.toggle("keyboard", keyboard);
    this.draw();
  }

  /** Writes the place at (u, v) and its height below the map. */
  tell(u, v) {
    const place = this.placeOf(u, v), height = this.heights.at(place);
    byId("map-place").textContent = `x ${place[0].toFixed(3)}  y ${place[1].toFixed(3)}` +
      (height === null ? "" : `  height ${height.toFixed(3)} m`);
  }

  draw() {
    this.asked ??= requestAnimationFrame(() => { this.asked = null; this.paint(); });
  }

  paint() {
    if (!this.scale || !this.size[0]) return;
    const context = this.canvas.getContext("2d"), ratio = this.canvas.width / this.size[0];
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.paintLayer(context, this.layer);
    if (this.other) this.paintOther(context);
    this.paintMarks(context);
    scaleBar(context, this.scale, this.size);
  }

  // Draws the visible part of the layer, because browsers do not draw very large pictures.
  paintLayer(context, layer) {
    const image = this.imageOf(layer);
    if (!image) return;
    const [left, top, width, height] = layer.place, [columns, rows] = layer.size;
    const perPixel = [this.scale * width / columns, this.scale * height / rows];
    const [u, v] = this.screenOf([left, top]);
    const cut = (begin, pixel, count, side) => [Math.max(0, Math.floor(-begin / pixel)),
                                                Math.min(count, Math.ceil((side - begin) / pixel))];
    const [first, last] = cut(u, perPixel[0], columns, this.size[0]);
    const [upper, lower] = cut(v, perPixel[1], rows, this.size[1]);
    if (first >= last || upper >= lower) return;
    context.imageSmoothingEnabled = perPixel[0] < PIXELS_WHEN_NEAR;
    context.imageSmoothingQuality = "high";
    context.drawImage(image, first, upper, last - first, lower - upper, u + first * perPixel[0],
                      v + upper * perPixel[1], (last - first) * perPixel[0], (lower - upper) * perPixel[1]);
  }

  // The other layer on the right of the line of the slider (compare.js).
  paintOther(context) {
    const [width, height] = this.size, line = this.cut * width;
    context.save();
    context.beginPath();
    context.rect(line, 0, width - line, height);
    context.clip();
    context.clearRect(line, 0, width - line, height);
    this.paintLayer(context, this.other);
    context.restore();
    context.fillStyle = "#fff";
    context.fillRect(line - 1, 0, 2, height);
  }

  paintMarks(context) {
    const places = this.path.map(point => this.screenOf(point.place));
    const ring = ([u, v], radius) => {
      context.beginPath();
      context.arc(u, v, radius, 0, 2 * Math.PI);
      for (const [color, width] of [["#000a", 4], ["#fff", 2]])
        Object.assign(context, { strokeStyle: color, lineWidth: width }) && context.stroke();
    };
    context.beginPath();
    places.forEach(([u, v], k) => k ? context.lineTo(u, v) : context.moveTo(u, v));
    for (const [color, width] of [["#000a", 5], ["#7db8e8", 2]])
      Object.assign(context, { strokeStyle: color, lineWidth: width }) && context.stroke();
    Object.assign(context, { font: "13px system-ui, sans-serif", strokeStyle: "#000a", lineWidth: 3,
                             fillStyle: "#fff", textAlign: "left", textBaseline: "alphabetic" });
    places.forEach((at, k) => {
      ring(at, 4);
      Object.assign(context, { strokeStyle: "#000a", lineWidth: 3 });
      context.strokeText(k + 1, at[0] + 8, at[1] - 6);
      context.fillText(k + 1, at[0] + 8, at[1] - 6);
    });
    if (this.region)
      ring(this.screenOf([this.region.x, this.region.y]),
           Math.max(12, 0.8 * Math.sqrt(this.region.area) * this.scale));
    if (this.keyboard) ring(this.size.map(side => side / 2), 8);
  }
}
