// SPDX-License-Identifier: GPL-3.0-or-later
// Moves the view with mouse, touch and keyboard. The view turns around `target` and keeps `up`.
import * as three from "three";

const KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Controls {
  /** `moved`: called after each change. `clicked(x, y)`: called for a click or a tap, with its place
   * on the canvas [CSS px]. */
  constructor(camera, canvas, moved, clicked) {
    Object.assign(this, { camera, canvas, moved, clicked });
    this.target = new three.Vector3();
    this.up = new three.Vector3(0, 0, 1);
    this.pointers = new Map();
    this.travelled = 0;
    canvas.addEventListener("pointerdown", event => this.press(event));
    canvas.addEventListener("pointermove", event => this.drag(event));
    for (const name of ["pointerup", "pointercancel"])
      canvas.addEventListener(name, event => this.release(event));
    canvas.addEventListener("wheel", event => {
      event.preventDefault();
      this.zoom(Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100) * 0.002));
    }, { passive: false });
    canvas.addEventListener("contextmenu", event => event.preventDefault());
    canvas.addEventListener("keydown", event => this.key(event));
  }

  press(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.focus({ preventScroll: true });
    if (this.pointers.size === 0) this.travelled = 0;
    this.pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
  }

  drag(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const spread = this.spread(), middle = this.middle();
    this.pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    const dx = event.offsetX - before[0], dy = event.offsetY - before[1];
    this.travelled += Math.hypot(dx, dy);
    if (this.pointers.size > 1) {
      const now = this.middle();
      this.pan(now[0] - middle[0], now[1] - middle[1]);
      if (spread > 0) this.zoom(spread / Math.max(this.spread(), 1));
    } else if (event.buttons & 6 || event.shiftKey) {
      this.pan(dx, dy);
    } else {
      this.turn(dx, dy);
    }
  }

  release(event) {
    const single = this.pointers.size === 1;
    if (!this.pointers.delete(event.pointerId)) return;
    if (!single) this.travelled = Infinity; // the end of a gesture is no tap
    if (event.type === "pointerup" && single && this.travelled < 6 && event.button === 0)
      this.clicked(event.offsetX, event.offsetY);
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const step = KEYS[event.key];
    if (step && event.shiftKey) this.pan(-40 * step[0], -40 * step[1]);
    else if (step) this.turn(-30 * step[0], -30 * step[1]);
    else if (event.key === "+" || event.key === "=") this.zoom(1 / 1.2);
    else if (event.key === "-") this.zoom(1.2);
    else return;
    event.preventDefault();
  }

  middle() {
    const all = [...this.pointers.values()];
    return [0, 1].map(k => all.reduce((sum, place) => sum + place[k], 0) / all.length);
  }

  spread() {
    const [a, b] = this.pointers.values();
    return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
  }

  turn(dx, dy) {
    const arm = this.camera.position.clone().sub(this.target);
    arm.applyAxisAngle(this.up, -dx * 0.006);
    const side = this.up.clone().cross(arm).normalize();
    if (side.lengthSq() > 0) {
      // The view stops shortly before it looks along the vertical.
      const angle = arm.angleTo(this.up);
      const next = Math.min(Math.max(angle - dy * 0.006, 0.01), Math.PI - 0.01);
      arm.applyAxisAngle(side, next - angle);
    }
    this.place(this.target.clone().add(arm));
  }

  pan(dx, dy) {
    const distance = this.camera.position.distanceTo(this.target);
    const perPixel = 2 * distance * Math.tan(this.camera.fov * Math.PI / 360) /
      this.canvas.clientHeight;
    const e = this.camera.matrixWorld.elements;
    const shift = new three.Vector3(e[0], e[1], e[2]).multiplyScalar(-dx * perPixel)
      .addScaledVector(new three.Vector3(e[4], e[5], e[6]), dy * perPixel);
    this.target.add(shift);
    this.place(this.camera.position.clone().add(shift));
  }

  zoom(factor) {
    const arm = this.camera.position.clone().sub(this.target);
    this.place(this.target.clone().addScaledVector(arm, factor));
  }

  /** Moves the eye to `eye`. The view looks at the target. */
  place(eye) {
    const distance = Math.max(eye.distanceTo(this.target), 1e-9);
    this.camera.position.copy(eye);
    this.camera.up.copy(this.up);
    this.camera.near = distance / 200;
    this.camera.far = distance * 200;
    this.camera.updateProjectionMatrix();
    this.camera.lookAt(this.target);
    this.camera.updateMatrixWorld();
    this.moved();
  }
}
