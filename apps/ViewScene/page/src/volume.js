// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh inside a path: the volume between it and the plane of the path, its surface and rugosity.
import { areaInside, inside } from "./clip.js";
import { areaOf, normalOf } from "./measure.js";

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const CELLS = 500; // along the longer side of the path

/** The frame of the path's plane: the plane has the normal for which the area of the path is
 * largest, on the side from which the photographs look (`towards`), and contains the mean of its
 * points. */
function planeOf(path, towards) {
  let normal = normalOf(path);
  if (dot(normal, towards) > 0) normal = normal.map(value => -value);
  const smallest = normal.map(Math.abs).indexOf(Math.min(...normal.map(Math.abs)));
  const axis = [0, 1, 2].map(k => (k === smallest ? 1 : 0) - normal[smallest] * normal[k]);
  const right = axis.map(value => value / Math.hypot(...axis));
  const up = [normal[1] * right[2] - normal[2] * right[1], normal[2] * right[0] - normal[0] * right[2],
              normal[0] * right[1] - normal[1] * right[0]];
  const mean = [0, 1, 2].map(k => path.reduce((sum, place) => sum + place[k], 0) / path.length);
  return place => {
    const d = place.map((value, k) => value - mean[k]);
    return [dot(d, right), dot(d, up), dot(d, normal)];
  };
}

// Raises the heights of the cells whose middles the triangle covers. Corners are [column, row,
// height], in cells.
function raise(heights, columns, rows, a, b, c) {
  const area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  if (!area) return;
  const first = k => Math.max(Math.ceil(Math.min(a[k], b[k], c[k])), 0);
  const last = (k, count) => Math.min(Math.floor(Math.max(a[k], b[k], c[k])), count - 1);
  for (let row = first(1), end = last(1, rows); row <= end; ++row) {
    for (let column = first(0), stop = last(0, columns); column <= stop; ++column) {
      const s = ((column - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (row - a[1])) / area;
      const t = ((b[0] - a[0]) * (row - a[1]) - (column - a[0]) * (b[1] - a[1])) / area;
      if (s < 0 || t < 0 || s + t > 1) continue;
      const height = a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2]);
      const cell = row * columns + column;
      if (!(heights[cell] >= height)) heights[cell] = height;
    }
  }
}

/** Inside the path, seen along the normal of its plane: the volumes of the mesh above and below the
 * plane, the share of the path that the mesh covers, the area of the mesh, and its rugosity: this
 * area divided by the area of the covered part of the path, or null without a covered part. Where
 * surfaces lie above each other, the one nearest to the cameras counts for volumes, and all count
 * for the area. `parts`: { positions, indices } of the mesh. */
export function surfaceOf(path, parts, towards) {
  const inPlane = planeOf(path, towards);
  const polygon = path.map(inPlane);
  const low = [0, 1].map(k => Math.min(...polygon.map(place => place[k])));
  const size = [0, 1].map(k => Math.max(...polygon.map(place => place[k])) - low[k]);
  const cell = Math.max(...size) / CELLS;
  const [columns, rows] = size.map(side => Math.ceil(side / cell) + 1);
  const heights = new Float64Array(columns * rows).fill(NaN);
  const outline = polygon.map(([x, y]) => [(x - low[0]) / cell, (y - low[1]) / cell]);
  let surface = 0; // in cells
  for (const { positions, indices } of parts) {
    const corner = i => {
      const [x, y, height] = inPlane([...positions.subarray(3 * i, 3 * i + 3)]);
      return [(x - low[0]) / cell, (y - low[1]) / cell, height / cell];
    };
    const apart = corners => [columns, rows].some((end, k) => corners.every(place => place[k] < 0) ||
      corners.every(place => place[k] > end));
    const corners = Array.from({ length: positions.length / 3 }, (_, i) => corner(i));
    for (let f = 0; f < indices.length; f += 3) {
      const face = [0, 1, 2].map(k => corners[indices[f + k]]);
      if (apart(face)) continue;
      raise(heights, columns, rows, ...face);
      surface += areaInside(outline, ...face);
    }
  }
  let above = 0, below = 0, covered = 0, all = 0;
  heights.forEach((height, k) => {
    if (!inside(polygon, low[0] + (k % columns) * cell, low[1] + Math.floor(k / columns) * cell))
      return;
    ++all;
    if (Number.isNaN(height)) return;
    ++covered;
    if (height > 0) above += height;
    else below -= height;
  });
  const share = covered / all, square = cell * cell;
  return { above: above * square * cell, below: below * square * cell, covered: share,
           surface: surface * square,
           rugosity: covered ? surface * square / (share * areaOf(path)) : null };
}
