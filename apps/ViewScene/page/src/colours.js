// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of the points by a value, and their legend.
import { make, byId } from "./elements.js";

// From dark blue over green to yellow: the lightness grows with the value.
const RAMP = [[59, 50, 130], [49, 104, 142], [38, 143, 140], [62, 184, 116], [157, 217, 60], [253, 231, 37]];

/** The colour [0, 255] of a share from 0 to 1, as [red, green, blue]. */
export function ramp(share) {
  const at = Math.min(Math.max(share, 0), 1) * (RAMP.length - 1);
  const k = Math.min(Math.floor(at), RAMP.length - 2), t = at - k;
  return RAMP[k].map((value, axis) => Math.round(value + t * (RAMP[k + 1][axis] - value)));
}

// The colours of 256 shares, one after the other: a cloud has millions of points.
const TABLE = new Uint8Array(Array.from({ length: 256 }, (_, k) => ramp(k / 255)).flat());

export const rampColor = share => `rgb(${ramp(share).join(",")})`;

/** A bar with the colours of the ramp between two labels. */
export function rampLegend(low, high) {
  const stops = RAMP.map(color => `rgb(${color.join(",")})`).join(",");
  return make("div", { class: "ramp" }, make("span", {}, low),
              make("span", { class: "bar", style: `background:linear-gradient(90deg,${stops})` }),
              make("span", {}, high));
}

const SAMPLES = 20000; // points from which the range of heights is taken

// The values that the shares `shares` of `values` do not exceed.
function quantiles(values, shares) {
  values.sort((a, b) => a - b);
  return shares.map(share => values[Math.round(share * (values.length - 1))] ?? 0);
}

// A sample of measureOf(chunk)(i) over the loaded points.
function sampled(cloud, measureOf) {
  const values = [], step = Math.max(1, Math.floor(cloud.points / SAMPLES));
  for (const chunk of cloud.chunks) {
    const value = measureOf(chunk);
    for (let i = 0; i < chunk.entry.points; i += step) values.push(value(i));
  }
  return values;
}

function heightOf(up, { entry: { low, size }, positions }) {
  const base = low.reduce((sum, value, k) => sum + value * up[k], 0);
  const [x, y, z] = size.map((side, k) => side * up[k] / 65535);
  return i => base + x * positions[3 * i] + y * positions[3 * i + 1] + z * positions[3 * i + 2];
}

function viewsOf({ views, lists }) {
  const lengths = lists.map(list => list.length);
  return i => views ? lengths[views[i]] : 0;
}

/** The ways to colour the points: a name, whether the scene has the data, and for a chunk the function
 * from the number of a point to its value. `range(values)`: the values of the first and the last
 * colour. */
export const MODES = {
  photographs: { name: "Colours", has: () => true },
  views: {
    name: "Views", title: "photographs that see a point",
    has: scene => scene.chunks.some(chunk => chunk.lists > 0),
    measureOf: () => viewsOf,
    range: values => [0, Math.max(2, quantiles(values, [0.99])[0])],
    text: value => String(Math.round(value))
  },
  height: {
    name: "Height", title: "height",
    has: () => true,
    measureOf: scene => chunk => heightOf(scene.view.up, chunk),
    range: values => quantiles(values, [0.01, 0.99]),
    text: (value, scene) => {
      const height = value + scene.origin.reduce((sum, v, k) => sum + v * scene.view.up[k], 0);
      return `${height.toFixed(2)}${scene.metric ? " m" : ""}`;
    }
  },
  errors: {
    name: "Errors", title: "distance to the true surface",
    has: scene => Boolean(scene.truth),
    measureOf: () => ({ entry, errors }) => i => entry.error_step * errors[i],
    range: values => [0, Math.max(quantiles(values, [0.95])[0], 1e-9)],
    text: distance
  }
};

/** A distance in millimetres, if the unit of the scene is the metre. */
export function distance(value, scene) {
  return scene.metric ? `${(1e3 * value).toFixed(value < 0.01 ? 2 : 1)} mm` : value.toPrecision(3);
}

export class Colours {
  /** `changed`: called when the colours have changed. */
  constructor(scene, cloud, changed) {
    Object.assign(this, { scene, cloud, changed, mode: "photographs" });
    this.select = byId("colours");
    this.select.replaceChildren(...Object.entries(MODES).filter(([, mode]) => mode.has(scene))
      .map(([value, { name }]) => make("option", { value }, name)));
    this.select.onchange = () => this.choose(this.select.value);
  }

  choose(name) {
    this.mode = name;
    this.range = null;
    this.early = !this.cloud.points;
    const mode = MODES[name];
    const legend = byId("legend");
    legend.hidden = !mode.measureOf;
    if (mode.measureOf) {
      this.measureOf = mode.measureOf(this.scene);
      this.range = mode.range(sampled(this.cloud, this.measureOf));
      const [low, high] = this.range.map(value => mode.text(value, this.scene));
      legend.replaceChildren(make("span", {}, mode.title), rampLegend(low, high));
    }
    for (const chunk of this.cloud.chunks) this.paint(chunk);
    this.changed();
  }

  /** Colours the points of a chunk, for example of one that was loaded later. */
  paint(chunk) {
    if (this.early) return this.choose(this.mode); // the range was that of no points
    if (!this.range) return chunk.recolor(null);
    const [low, high] = this.range, value = this.measureOf(chunk);
    const colors = new Uint8Array(3 * chunk.entry.points), factor = 255 / (high - low || 1);
    for (let i = 0; i < chunk.entry.points; ++i) {
      const at = 3 * Math.round(Math.min(Math.max((value(i) - low) * factor, 0), 255));
      colors[3 * i] = TABLE[at];
      colors[3 * i + 1] = TABLE[at + 1];
      colors[3 * i + 2] = TABLE[at + 2];
    }
    chunk.recolor(colors);
  }
}
