// SPDX-License-Identifier: GPL-3.0-or-later
// The tab "Colours": what RestoreColors found, and photographs as they were taken and without water.
import { byId, draw, make, table } from "./elements.js";

const LIGHTS = { sun: "daylight", lamp: "lamps that move with the camera" };
const CHANNELS = ["red", "green", "blue"], COLORS = ["#f07070", "#5fc46f", "#6fa8ff"];
const percent = value => `${(100 * value).toFixed(1)} %`;

const estimate = ({ value, sigma, unit }) =>
  `${value.toFixed(3)}${sigma === null ? "" : ` ± ${sigma.toFixed(3)}`}${unit ? ` ${unit}` : ""}`;

const rowsOf = ({ name, assumed, values }) => values.length
  ? values.map(value => [`${name}, ${value.name}${assumed ? ", assumed" : ""}`, estimate(value)])
  : [[name, "not determined: left as it is"]];

const findings = colors => [
  table([["Light", LIGHTS[colors.light]], ["White", colors.white],
         ...(colors.charts ?? []).map(({ photograph, ciede2000 }) =>
           [`Chart in ${photograph}`, `CIEDE2000 ${ciede2000.toFixed(1)}`]),
         ...colors.water ? [["Water like", colors.water]] : [],
         ["Differences of a point before", percent(colors.spread_before)],
         ["and after", percent(colors.spread_after)]]),
  make("p", { class: "hint" }, "Of the light of a point of the surface between photographs, as a share of how much " +
    "points differ."),
  make("h2", {}, "Water"), table(colors.channels.flatMap(rowsOf), "number"),
  make("p", { class: "hint" }, colors.light === "sun" ? "± is one standard deviation."
    : "On one way. The light of the lamps is a grid over image and distance, which starts from this loss.")];

const WIDTH = 340, HEIGHT = 190, LEFT = 34, RIGHT = 8, TOP = 8, BOTTOM = 32; // of the chart

/** The chart of brightness by distance; the lines before are dashed. */
function chart(rows) {
  const ways = rows.map(row => row.way_m), low = Math.min(...ways), high = Math.max(...ways);
  const most = 1.05 * Math.max(1e-9, ...rows.flatMap(row => [...row.before, ...row.after]));
  const x = way => LEFT + (WIDTH - LEFT - RIGHT) * (high > low ? (way - low) / (high - low) : 0.5);
  const y = light => HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * Math.max(light, 0) / most;
  const line = (key, k) => draw("polyline", {
    class: key, stroke: COLORS[k],
    points: rows.map(row => `${x(row.way_m).toFixed(1)},${y(row[key][k]).toFixed(1)}`).join(" ") });
  const known = CHANNELS.map((_, k) => k).filter(k => rows.some(row => row.after[k] > 0));
  const text = (at, words, anchor) => draw("text", { x: at[0], y: at[1], "text-anchor": anchor }, words);
  const axes = draw("path", { class: "axes", d: `M${LEFT},${TOP}V${HEIGHT - BOTTOM}H${WIDTH - RIGHT}` });
  const label = "Median relative light by the way in water: dashed before, solid after";
  return draw("svg", { id: "by-way", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": label }, axes,
              ...["before", "after"].flatMap(key => known.map(k => line(key, k))),
              text([LEFT - 4, y(0)], "0", "end"), text([LEFT - 4, TOP + 10], most.toPrecision(2), "end"),
              text([LEFT, HEIGHT - 16], low.toFixed(1), "start"),
              text([WIDTH - RIGHT, HEIGHT - 16], high.toFixed(1), "end"),
              text([(LEFT + WIDTH - RIGHT) / 2, HEIGHT - 3], "way in water [m]", "middle"));
}

const brightness = rows => rows?.length ? [
  make("h2", {}, "Brightness by distance"), chart(rows),
  make("p", { class: "hint" }, "Median relative light. Dashed: before; solid: after. Level lines: no water is left.")
] : [];

/** A photograph before, and over its left part, up to a slider, after. */
function comparison({ name, before, after }) {
  const over = make("img", { src: after, alt: `${name} without water`, class: "over" });
  const slider = make("input", { type: "range", min: 0, max: 100, value: 50,
                                 "aria-label": `${name}: part without water` });
  const cut = () => { over.style.clipPath = `inset(0 ${100 - slider.value}% 0 0)`; };
  slider.addEventListener("input", cut);
  cut();
  return make("figure", { class: "comparison" },
              make("div", { class: "both" }, make("img", { src: before, alt: name }), over), slider,
              make("figcaption", {}, make("span", {}, "after"), make("span", {}, name), make("span", {}, "before")));
}

/** Shows scene.colors. */
export function showRestored(colors) {
  byId("restored").replaceChildren(
    ...colors.light ? findings(colors) : [], ...brightness(colors.by_way),
    make("h2", {}, "Photographs"), make("div", { class: "cards" }, ...colors.pictures.map(comparison)));
}
