// SPDX-License-Identifier: GPL-3.0-or-later
// The cloud: chunks of points (libs/view/cloud_data.h), drawn by level of detail.
import * as three from "three";

const VERTEX = `
  attribute vec3 color;
  uniform float size;
  varying vec3 shown;
  void main() {
    shown = color;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    gl_PointSize = size;
  }`;
const FRAGMENT = `
  varying vec3 shown;
  void main() { gl_FragColor = vec4(shown, 1.0); }`;

export class Cloud {
  constructor() {
    this.group = new three.Group();
    this.chunks = []; // in the order of loading: coarse levels first
    this.material = new three.ShaderMaterial(
      { vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: { size: { value: 2 } } });
    this.points = 0;
  }

  /** Adds a chunk and returns it. `entry`: its description in data/scene.js. Its recolor(colors)
   * replaces the colours of its points; null: those of the file. */
  add(entry, bytes) {
    const n = entry.points, views = entry.lists > 0;
    const words = new Uint16Array(bytes.buffer, bytes.byteOffset, bytes.byteLength >> 1);
    const positions = words.slice(0, 3 * n);
    const colors = bytes.slice(bytes.length - 3 * n);
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(positions, 3, true));
    geometry.setAttribute("color", new three.BufferAttribute(colors, 3, true));
    geometry.boundingSphere = new three.Sphere(new three.Vector3(0.5, 0.5, 0.5), Math.sqrt(0.75));
    const object = new three.Points(geometry, this.material);
    object.position.fromArray(entry.low);
    // A side of length 0 would make the matrix singular.
    object.scale.fromArray(entry.size.map(side => side || 1e-9));
    object.updateMatrixWorld();
    const end = (bytes.length - 3 * n) >> 1;
    this.group.add(object);
    const chunk = { entry, object, positions,
                    views: views ? words.slice(3 * n, 4 * n) : null,
                    lists: views ? listsOf(words.slice(4 * n, end), entry.lists) : [],
                    errors: entry.error_step ? words.slice(end - n, end) : null };
    chunk.recolor = painted => {
      const attribute = geometry.getAttribute("color");
      attribute.array = painted ?? colors;
      attribute.needsUpdate = true;
    };
    this.chunks.push(chunk);
    this.points += n;
    return chunk;
  }

  /** Chooses the points to draw: about those from number `first` to `last`, in an order in which the
   * first points are an even sample. These are the coarse levels, and of the next level the same
   * share of every chunk, because the points of a chunk are in random order. */
  show(first, last) {
    for (let level = 0, at = 0, before = 0; at < this.chunks.length; ++level) {
      const begin = at;
      let points = 0;
      for (; at < this.chunks.length && this.chunks[at].entry.level === level; ++at)
        points += this.chunks[at].entry.points;
      const share = number => Math.min(Math.max((number - before) / points, 0), 1);
      for (const { entry, object } of this.chunks.slice(begin, at)) {
        const [low, high] = [first, last].map(number => Math.ceil(share(number) * entry.points));
        object.visible = high > low;
        object.geometry.setDrawRange(low, high - low);
      }
      before += points;
    }
  }

  position(chunk, i) {
    return [0, 1, 2].map(
      k => chunk.entry.low[k] + chunk.entry.size[k] * chunk.positions[3 * i + k] / 65535);
  }

  viewsOf(chunk, i) {
    return chunk.views ? chunk.lists[chunk.views[i]] : null;
  }

  /** The distance to the true surface, or null. */
  errorOf(chunk, i) {
    return chunk.errors ? chunk.entry.error_step * chunk.errors[i] : null;
  }

  at(chunk, i) {
    return { position: this.position(chunk, i), views: this.viewsOf(chunk, i),
             error: this.errorOf(chunk, i) };
  }

  /** The point at (x, y) of the canvas [CSS px], as { position, views, error }, or null. Of the points
   * within `radius` pixels, a nearer one is preferred to one that lies better. */
  pick(camera, width, height, x, y, radius = 7) {
    const world = new three.Matrix4()
      .multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    let best = null, least = Infinity;
    for (const chunk of this.chunks) {
      const e = new three.Matrix4().multiplyMatrices(world, chunk.object.matrixWorld).elements;
      if (outside(e, width, height, x, y, radius)) continue;
      const p = chunk.positions;
      for (let i = 0; i < p.length; i += 3) {
        const a = p[i] / 65535, b = p[i + 1] / 65535, c = p[i + 2] / 65535;
        const w = e[3] * a + e[7] * b + e[11] * c + e[15];
        if (w <= 0) continue;
        const dx = ((e[0] * a + e[4] * b + e[8] * c + e[12]) / w + 1) * width / 2 - x;
        const dy = (1 - (e[1] * a + e[5] * b + e[9] * c + e[13]) / w) * height / 2 - y;
        const far2 = (dx * dx + dy * dy) / (radius * radius);
        if (far2 > 1) continue;
        const cost = w * (1 + 0.05 * far2);
        if (cost < least) { least = cost; best = [chunk, i / 3]; }
      }
    }
    return best && this.at(...best);
  }

  /** The point nearest to `place` [scene], as { position, views, error }, or null. */
  nearest(place) {
    let best = null, least = Infinity;
    for (const chunk of this.chunks) {
      const { low, size } = chunk.entry;
      const gap = place.map((value, k) => Math.max(low[k] - value, 0, value - low[k] - size[k]));
      if (gap[0] ** 2 + gap[1] ** 2 + gap[2] ** 2 >= least) continue;
      const p = chunk.positions;
      const scale = size.map(side => side / 65535), at = place.map((value, k) => value - low[k]);
      for (let i = 0; i < p.length; i += 3) {
        const d = (p[i] * scale[0] - at[0]) ** 2 + (p[i + 1] * scale[1] - at[1]) ** 2 +
          (p[i + 2] * scale[2] - at[2]) ** 2;
        if (d < least) { least = d; best = [chunk, i / 3]; }
      }
    }
    return best && this.at(...best);
  }
}

// The lists of views, one after the other: a length, and as many numbers of cameras.
function listsOf(words, count) {
  const lists = [];
  for (let at = 0; lists.length < count; at += 1 + words[at])
    lists.push(words.subarray(at + 1, at + 1 + words[at]));
  return lists;
}

// True if no point of the unit cube can appear within `radius` pixels of (x, y). The matrix e maps
// the cube to clip coordinates.
function outside(e, width, height, x, y, radius) {
  const limits = [(x - radius) / width * 2 - 1, (x + radius) / width * 2 - 1,
                  1 - (y + radius) / height * 2, 1 - (y - radius) / height * 2];
  const beyond = [true, true, true, true, true];
  for (let corner = 0; corner < 8; ++corner) {
    const a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
    const [X, Y, w] = [0, 1, 3].map(k => e[k] * a + e[k + 4] * b + e[k + 8] * c + e[k + 12]);
    beyond[0] &&= X < limits[0] * w;
    beyond[1] &&= X > limits[1] * w;
    beyond[2] &&= Y < limits[2] * w;
    beyond[3] &&= Y > limits[3] * w;
    beyond[4] &&= w <= 0;
  }
  return beyond.some(value => value);
}
