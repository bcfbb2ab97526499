// SPDX-License-Identifier: GPL-3.0-or-later
// The area of the part of a triangle that lies inside a path, seen along the normal of its plane.

const cross = (a, b, p) => (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);

/** Whether (x, y) lies inside the polygon. */
export function inside(polygon, x, y) {
  let odd = false;
  polygon.forEach(([ax, ay], k) => {
    const [bx, by] = polygon[(k + 1) % polygon.length];
    if (ay > y !== by > y && x < ax + (y - ay) * (bx - ax) / (by - ay)) odd = !odd;
  });
  return odd;
}

// The part of the polygon to the left of the line from a to b.
function leftOf(polygon, a, b) {
  const part = [];
  polygon.forEach((p, k) => {
    const q = polygon[(k + 1) % polygon.length];
    const dp = cross(a, b, p), dq = cross(a, b, q);
    if (dp >= 0) part.push(p);
    if (dp >= 0 !== dq >= 0) {
      const t = dp / (dp - dq);
      part.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
    }
  });
  return part;
}

function areaOf(polygon) {
  let sum = 0;
  for (let k = 1; k + 1 < polygon.length; ++k) sum += cross(polygon[0], polygon[k], polygon[k + 1]) / 2;
  return Math.abs(sum);
}

/** The area of the part of the triangle (a, b, c) whose x and y lie inside `polygon`. Corners are
 * [x, y, height]. A triangle that is vertical counts by its corners and its middle. */
export function areaInside(polygon, a, b, c) {
  const flat = cross(a, b, c) / 2;
  const [u, v] = [b, c].map(corner => corner.map((value, k) => value - a[k]));
  const whole = Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                           u[0] * v[1] - u[1] * v[0]) / 2;
  if (Math.abs(flat) < 1e-6 * whole) {
    const middle = [0, 1].map(k => (a[k] + b[k] + c[k]) / 3);
    return whole * [a, b, c, middle].filter(([x, y]) => inside(polygon, x, y)).length / 4;
  }
  const [first, second, third] = flat > 0 ? [a, b, c] : [a, c, b];
  const part = leftOf(leftOf(leftOf(polygon, first, second), second, third), third, first);
  return whole * Math.min(areaOf(part) / Math.abs(flat), 1);
}
