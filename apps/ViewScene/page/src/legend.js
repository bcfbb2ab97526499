// SPDX-License-Identifier: GPL-3.0-or-later
// Legends: a bar of colours with the values of its ends, or a list of classes.
import { make } from "./elements.js";

/** The values `low` and `high` in words, in millimetres if both are small. */
export function ends({ low, high, unit }) {
  const most = Math.max(Math.abs(low), Math.abs(high));
  if (unit === "m" && most < 0.1)
    return [low, high].map(value => `${(1000 * value).toFixed(most < 0.01 ? 2 : 1)} mm`);
  const digits = unit === "photographs" ? 0 : 3;
  return [low, high].map(value => `${value.toFixed(digits)} ${unit}`.trim());
}

/** The elements of a legend; none without a legend. */
export function legendOf(legend) {
  if (!legend) return [];
  if (legend.classes)
    return [make("div", { class: "classes" }, ...legend.classes.map(({ color, text }) => make(
      "span", { class: "kind", style: `--color:${color}` }, text)))];
  const bar = `linear-gradient(to right, ${legend.colors.join(", ")})`;
  return [make("div", { class: "bar", style: `background:${bar}` }),
          make("div", { class: "ends" }, ...ends(legend).map(text => make("span", {}, text)))];
}
