// SPDX-License-Identifier: GPL-3.0-or-later
// The heights of a map, its frame in the world, and its scale bar.

/** The heights of the map (HeightData in libs/view/map_pictures.h). */
export class Heights {
  constructor(entry, bytes) {
    if (!entry) return;
    this.entry = entry;
    this.values = new Uint16Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
  }

  pixel(column, row) {
    const { size: [columns, rows], low, step } = this.entry;
    if (column < 0 || row < 0 || column >= columns || row >= rows) return null;
    const value = this.values[row * columns + column];
    return value ? low + (value - 1) * step : null;
  }

  /** The height [m] at [x, y], interpolated between pixels that have one; null without a height. */
  at([x, y]) {
    if (!this.entry) return null;
    const { size: [columns, rows], place: [left, top, width, height] } = this.entry;
    const u = (x - left) / width * columns, v = (top - y) / height * rows;
    const here = this.pixel(Math.floor(u), Math.floor(v));
    if (here === null) return null;
    const column = Math.floor(u - 0.5), row = Math.floor(v - 0.5);
    const a = u - 0.5 - column, b = v - 0.5 - row;
    const corner = (i, j) => this.pixel(column + i, row + j) ?? here;
    return (1 - b) * ((1 - a) * corner(0, 0) + a * corner(1, 0)) +
      b * ((1 - a) * corner(0, 1) + a * corner(1, 1));
  }
}

/** The point of the scene at the map's place and height, or null if the map does not state its axes.
 * map = axes * world + offset; the scene's frame has its origin at `origin`. */
export function sceneOf(map, [x, y], height, origin) {
  if (!map.axes || height === null) return null;
  const d = [x, y, height].map((value, k) => value - map.offset[k]);
  return [0, 1, 2].map(k => map.axes[k] * d[0] + map.axes[3 + k] * d[1] + map.axes[6 + k] * d[2] - origin[k]);
}

/** 1, 2 or 5 times a power of ten, at most `most`. */
export function roundLength(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].find(factor => factor * power <= most * (1 + 1e-9)) * power;
}

const inWords = metres => metres >= 1000 ? `${metres / 1000} km` : metres >= 1 ? `${metres} m`
  : metres >= 0.01 ? `${Math.round(metres * 100)} cm` : `${+(metres * 1000).toPrecision(1)} mm`;

/** Draws a scale bar in the lower right corner. `scale`: [px / m]. */
export function scaleBar(context, scale, [width, height]) {
  const metres = roundLength(Math.min(160, 0.3 * width) / scale), long = metres * scale;
  const right = width - 14, bottom = height - 14;
  const bar = () => {
    context.beginPath();
    context.moveTo(right - long, bottom - 6);
    context.lineTo(right - long, bottom);
    context.lineTo(right, bottom);
    context.lineTo(right, bottom - 6);
    context.stroke();
  };
  Object.assign(context, { strokeStyle: "#000c", lineWidth: 5, lineJoin: "round" });
  bar();
  Object.assign(context, { strokeStyle: "#fff", lineWidth: 2 });
  bar();
  Object.assign(context, { font: "13px system-ui, sans-serif", textAlign: "right", fillStyle: "#fff",
                           textBaseline: "alphabetic", strokeStyle: "#000c", lineWidth: 3 });
  context.strokeText(inWords(metres), right, bottom - 10);
  context.fillText(inWords(metres), right, bottom - 10);
}
