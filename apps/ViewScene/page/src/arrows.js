// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of residuals: one arrow for each cell of a grid over the image.
import { rampColor } from "./colours.js";

const LEAST = 3; // observations of a cell with an arrow
const NAMESPACE = "http://www.w3.org/2000/svg";

function shape(name, attributes, ...children) {
  const element = document.createElementNS(NAMESPACE, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/** A round number (1, 2 or 5 times a power of ten) that is at least `value`. */
export function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * ([1, 2, 5].find(factor => factor * power >= value * (1 - 1e-9)) ?? 10);
}

function arrow([x, y], [dx, dy], width, color) {
  const size = Math.hypot(dx, dy), head = Math.min(size, 3.5 * width);
  if (!size) return [];
  const [ux, uy] = [dx / size, dy / size], end = [x + dx, y + dy];
  const side = sign => [end[0] - head * ux - sign * head * 0.5 * uy,
                        end[1] - head * uy + sign * head * 0.5 * ux].join(",");
  return [shape("line", { x1: x, y1: y, x2: end[0] - head * ux * 0.8, y2: end[1] - head * uy * 0.8,
                          stroke: color, "stroke-width": width }),
          shape("polygon", { points: `${end.join(",")} ${side(1)} ${side(-1)}`, fill: color })];
}

const describe = ([count, x, y, error, rms]) => count < LEAST ? `${count} observations` :
  `${count} observations, mean ${x.toFixed(3)}, ${y.toFixed(3)} px, ` +
  `standard error ${error.toFixed(3)} px, RMS ${rms.toFixed(3)} px`;

// The error [px] that gets the last colour and an arrow a little longer than a cell: most cells have
// smaller errors. Not much below the noise, so that arrows stay short without a pattern.
function scaleOf(lengths, noise) {
  lengths.sort((a, b) => a - b);
  return roundUp(Math.max(0.5 * noise, 0.001, lengths[Math.floor(0.97 * (lengths.length - 1))] ?? 0));
}

/** The picture of `grid` (libs/diagnosis/residual_pattern.h) for an image of `size` pixels, the error [px]
 * of the last colour, and the magnification of the arrows. `noise`: of one error [px]. `photo`: the
 * file behind the arrows, or null. */
export function drawArrows(grid, size, noise, photo) {
  const [width, height] = size;
  const [w, h] = [width / grid.columns, height / grid.rows];
  const shown = grid.cells.filter(cell => cell[0] >= LEAST);
  const longest = scaleOf(shown.map(cell => Math.hypot(cell[1], cell[2])), noise);
  const magnified = 1.2 * Math.min(w, h) / longest;
  const shapes = photo ? [shape("image", { href: photo, width, height, opacity: 0.3 })] : [];
  const arrows = shape("g", { "pointer-events": "none" });
  grid.cells.forEach((cell, k) => {
    const [left, top] = [(k % grid.columns) * w, Math.floor(k / grid.columns) * h];
    const [count, x, y, error] = cell, length = Math.hypot(x, y);
    const sure = length > 2 * error;
    const color = rampColor(length / longest);
    const fill = count < LEAST ? "none" : color;
    shapes.push(shape("g", {}, shape("title", {}, describe(cell)),
      shape("rect", { x: left, y: top, width: w, height: h, fill, "fill-opacity": photo ? 0.4 : 0.6,
                      stroke: "#343a42", "stroke-width": width / 900, "pointer-events": "all" })));
    if (count >= LEAST)
      arrows.append(...arrow([left + w / 2 - magnified * x / 2, top + h / 2 - magnified * y / 2],
                             [magnified * x, magnified * y], width / 200, sure ? "#fff" : "#aab2bc"));
  });
  shapes.push(arrows); // behind no cell
  const svg = shape("svg", { viewBox: `0 0 ${width} ${height}`, class: "arrows", role: "img",
                             "aria-label": "Mean residuals over the image" }, ...shapes);
  return { svg, longest, magnified };
}
