// SPDX-License-Identifier: GPL-3.0-or-later
// The cameras as frusta, coloured by the kind of their port. The edges of a frustum are rays in the
// scene's medium, so they show the refracted field of view.
import * as three from "three";

export const PORTS = { none: ["no port", 0xb8bdc4], flat: ["flat port", 0xe8a33d],
                       dome: ["dome port", 0x58a6d6] };

export const portOf = camera => camera.port ? camera.port.kind : "none";

export class Cameras {
  /** `length`: of the edges [scene]. */
  constructor(cameras, length) {
    this.group = new three.Group();
    for (const [kind, [, color]] of Object.entries(PORTS)) {
      const lines = cameras.filter(camera => portOf(camera) === kind)
        .flatMap(camera => frustum(camera, length));
      if (lines.length) this.group.add(segments(lines, color));
    }
    this.chosen = new three.Group();
    this.group.add(this.chosen);
    Object.assign(this, { cameras, length });
  }

  /** Shows the frustum of camera `number` brighter; -1: of none. */
  choose(number) {
    this.chosen.children.forEach(child => child.geometry.dispose());
    this.chosen.remove(...this.chosen.children);
    if (number >= 0)
      this.chosen.add(segments(frustum(this.cameras[number], 1.02 * this.length), 0xffffff));
  }
}

function frustum(camera, length) {
  const c = camera.corners, ends = [0, 2, 4, 6].map(
    k => c[k].map((value, axis) => value + length * c[k + 1][axis]));
  return [0, 1, 2, 3].flatMap(k => [c[2 * k], ends[k], ends[k], ends[(k + 1) % 4]]);
}

function segments(places, color) {
  const geometry = new three.BufferGeometry();
  geometry.setAttribute("position",
                        new three.BufferAttribute(new Float32Array(places.flat()), 3));
  return new three.LineSegments(geometry, new three.LineBasicMaterial({ color }));
}
