// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths and areas of a path of picked points, and their table as CSV.

const minus = (a, b) => a.map((value, k) => value - b[k]);
const length = a => Math.hypot(...a);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]];

export const distance = (a, b) => length(minus(a, b));

/** The length of each segment of the path. */
export const segmentsOf = path => path.slice(1).map((place, k) => distance(place, path[k]));

export const total = path => segmentsOf(path).reduce((sum, value) => sum + value, 0);

// The sum of the areas of a fan of triangles, as vectors along their normals.
function areaVector(path) {
  const sum = [0, 0, 0];
  for (let i = 1; i + 1 < path.length; ++i)
    cross(minus(path[i], path[0]), minus(path[i + 1], path[0])).forEach((v, k) => { sum[k] += v / 2; });
  return sum;
}

/** The area of the closed polygon, seen along the normal for which the area is largest, and this
 * normal. */
export const areaOf = path => length(areaVector(path));

export const normalOf = path => areaVector(path).map(value => value / areaOf(path));

/** A length (power 1), an area (2) or a volume (3) for people. `unit`: "m", or "" if the unit is not known. */
export function quantity(value, unit, power = 1) {
  const exponent = unit ? ["", "²", "³"][power - 1] : "";
  const [factor, prefix] = !unit ? [1, ""] : power === 1 && value < 0.1 ? [1e3, "m"]
    : power === 2 && value < 0.01 ? [1e4, "c"] : power === 3 && value < 0.001 ? [1e6, "c"] : [1, ""];
  const digits = factor > 1 ? 2 : power === 3 ? 6 : 4;
  return `${(factor * value).toFixed(digits)} ${prefix}${unit}${exponent}`.trim();
}

/** The table of `paths`, with coordinates in the world: `origin` is the origin of the scene's
 * frame. A path may have the property `volumes`. */
export function csv(paths, origin) {
  const rows = ["path,point,x,y,z,segment,length,area,volume_above,volume_below,surface,rugosity"];
  paths.forEach((path, number) => {
    let sum = 0;
    path.forEach((place, k) => {
      const step = k ? distance(place, path[k - 1]) : 0;
      sum += step;
      const last = k + 1 === path.length;
      rows.push([number + 1, k + 1, ...place.map((v, axis) => (v + origin[axis]).toFixed(6)),
                 step.toFixed(6), sum.toFixed(6), last ? areaOf(path).toFixed(6) : "",
                 ...[["above", 9], ["below", 9], ["surface", 6], ["rugosity", 6]].map(
                   ([name, digits]) => last && path.volumes
                     ? path.volumes[name]?.toFixed(digits) ?? "" : "")].join(","));
    });
  });
  return rows.join("\n") + "\n";
}
