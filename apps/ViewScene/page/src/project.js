// SPDX-License-Identifier: GPL-3.0-or-later
// The exact projection of a point into a photograph: behind a flat port, behind a dome, or in air,
// with the distortion of the lens. docs/refraction.md derives the formulas. The cameras are those of
// libs/view/camera_data.h. Points are arrays [x, y, z].

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const combine = (a, x, b, y) => [a * x[0] + b * y[0], a * x[1] + b * y[1], a * x[2] + b * y[2]];

/** The point x of the scene in the frame of the camera. */
export function toCamera(camera, x) {
  const d = combine(1, x, -1, camera.centre);
  const r = camera.rotation;
  return [dot(r.slice(0, 3), d), dot(r.slice(3, 6), d), dot(r.slice(6, 9), d)];
}

// The direction in air of the light from X behind a flat port; null if X is not in the water. The
// equation t (d_a + d_g/q_g + z_w/q_w) = rho is increasing and concave in t. So Newton's steps from
// the paraxial solution, which is too small, rise to the root.
function throughFlatPort(port, X) {
  const n = port.normal;
  const muGlass = port.indices[1] / port.indices[0], muWater = port.indices[2] / port.indices[0];
  const height = dot(n, X), inWater = height - port.distance - port.thickness;
  if (!(inWater > 1e-9)) return null;
  const across = combine(1, X, -height, n);
  const rho = Math.hypot(...across);
  if (rho === 0) return n;
  const terms = [[port.thickness, muGlass], [inWater, muWater]];
  let t = rho / (port.distance + port.thickness / muGlass + inWater / muWater);
  for (let step = 0; step < 100; ++step) {
    let secant = port.distance, slope = port.distance;
    for (const [length, mu] of terms) {
      const q2 = mu * mu + (mu * mu - 1) * t * t, q = Math.sqrt(q2);
      secant += length / q;
      slope += length * mu * mu / (q * q2);
    }
    const next = t - (t * secant - rho) / slope;
    const rises = next > t;
    t = next;
    if (!rises && step > 0) break;
  }
  return combine(1, n, t / rho, across);
}

// sin(delta)/k and cos(delta) for delta = asin(k a) - asin(k b), and their derivatives by k^2.
function turnBetween(a, b, k2) {
  const cosA = Math.sqrt(1 - k2 * a * a), cosB = Math.sqrt(1 - k2 * b * b);
  const half = -0.5 / (cosA * cosB);
  const slopeA = a * a * cosB * half, slopeB = b * b * cosA * half;
  return { sine: a * cosB - b * cosA, cosine: cosA * cosB + k2 * a * b,
           sineSlope: a * slopeB - b * slopeA,
           cosineSlope: slopeA * cosB + cosA * slopeB + a * b };
}

function domeTurn(inverse, k2) {
  const i = turnBetween(inverse[0], inverse[1], k2), o = turnBetween(inverse[2], inverse[3], k2);
  return {
    sine: i.sine * o.cosine + i.cosine * o.sine,
    cosine: i.cosine * o.cosine - k2 * i.sine * o.sine,
    sineSlope: i.sineSlope * o.cosine + i.sine * o.cosineSlope + i.cosineSlope * o.sine +
      i.cosine * o.sineSlope,
    cosineSlope: i.cosineSlope * o.cosine + i.cosine * o.cosineSlope - i.sine * o.sine -
      k2 * (i.sineSlope * o.sine + i.sine * o.sineSlope)
  };
}

// The direction in air of the light from X behind a dome; null if X is not in the water. Newton's
// method for the unknown zeta of refractive/dome_port_projector.h.
function throughDome(port, X) {
  const C = port.centre, [air, glass, water] = port.indices;
  const outer = port.inner_radius + port.thickness;
  const fromCentre = combine(1, X, -1, C);
  if (!(dot(fromCentre, fromCentre) > outer * outer)) return null;
  const inverse = [1 / port.inner_radius, air / (glass * port.inner_radius),
                   air / (glass * outer), air / (water * outer)];
  const inverseMu = air / water, inverseRange = 1 / Math.hypot(...X);
  const d = combine(inverseRange, X, 0, X);
  const c = dot(d, C), C2 = dot(C, C);
  const axial = inverse[0] - inverse[1] + inverse[2] - inverse[3];
  let zeta = (1 - inverseMu / (1 + c * axial)) * inverseRange - axial / (1 + c * axial);
  for (let step = 0; step < 30; ++step) {
    const across = c - zeta * C2;
    const norm = Math.sqrt(1 - zeta * (c + across));
    const p = across / norm, k2 = (C2 - c * c) / (norm * norm);
    const turn = domeTurn(inverse, k2);
    const q = turn.cosine + p * turn.sine, ratio = turn.sine * norm / q;
    const h = zeta - (1 - inverseMu / q) * inverseRange + ratio;
    const k2Slope = 2 * k2 * p / norm, pSlope = (p * p - C2) / norm;
    const sineSlope = turn.sineSlope * k2Slope;
    const qSlope = turn.cosineSlope * k2Slope + p * sineSlope + turn.sine * pSlope;
    const slope = 1 + (sineSlope * norm - turn.sine * p -
                       qSlope * (ratio + inverseMu * inverseRange / q)) / q;
    const next = zeta - h / slope;
    if (!(Math.abs(next - zeta) > 1e-15 * Math.abs(zeta))) break;
    zeta = next;
  }
  return combine(1, d, -zeta, C);
}

const series = (a, x) => a.reduceRight((sum, value) => sum * x + value, 0);

// The lens's distortion of the tangents (u, v); null beyond the lens's field.
function distorted(lens, u, v) {
  u *= lens.spread;
  v *= lens.spread;
  const r = Math.hypot(u, v);
  const squeeze = lens.fisheye && r > 0 ? Math.atan(r) / r : 1;
  const x = u * squeeze, y = v * squeeze, s = x * x + y * y;
  if (s > lens.field * lens.field) return null;
  const ratio = series(lens.above, s) / (1 + s * series(lens.below, s));
  const [p1, p2] = lens.tangential;
  return [x * ratio + 2 * p1 * x * y + p2 * (s + 2 * x * x) + lens.prism[0] * s,
          y * ratio + 2 * p2 * x * y + p1 * (s + 2 * y * y) + lens.prism[1] * s];
}

/** The pixel [u, v] of the point x of the scene, with pixel centres at integers; null if the camera
 * cannot see x. The pixel may lie outside the image. */
export function project(camera, x) {
  let direction = toCamera(camera, x);
  if (camera.port)
    direction = (camera.port.kind === "dome" ? throughDome : throughFlatPort)(camera.port, direction);
  if (!direction || !(direction[2] > 0)) return null;
  let tangents = [direction[0] / direction[2], direction[1] / direction[2]];
  if (camera.distortion) tangents = distorted(camera.distortion, ...tangents);
  if (!tangents) return null;
  const [fx, fy, cx, cy] = camera.lens;
  return [fx * tangents[0] + cx, fy * tangents[1] + cy];
}

/** True if the pixel lies in the image of the camera. */
export function inImage(camera, pixel) {
  return pixel !== null && pixel.every((p, k) => p >= -0.5 && p <= camera.size[k] - 0.5);
}

/** The largest distance [px] between the projections of this file and the pixels that the camera
 * brings with it; 0 if it brings none. */
export function largestError(camera) {
  return Math.max(0, ...camera.check.map(([x, y, z, u, v]) => {
    const pixel = project(camera, [x, y, z]);
    return pixel ? Math.hypot(pixel[0] - u, pixel[1] - v) : Infinity;
  }));
}
