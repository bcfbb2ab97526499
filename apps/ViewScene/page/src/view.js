// SPDX-License-Identifier: GPL-3.0-or-later
// The picture: renderer, camera, what is shown, and the first view.
import * as three from "three";
import { Cameras } from "./cameras.js";
import { Cloud } from "./cloud.js";
import { Controls } from "./controls.js";
import { byId } from "./elements.js";
import { Mesh } from "./mesh.js";

const GROUND = 0x171a1e;
const STILL = 250; // [ms] without a move before more points are drawn
// The time that a picture may take while the view moves, and a portion when it stands still [ms].
const MOVING_TIME = 40, PORTION_TIME = 150;
const FEWEST = 10000; // points while the view moves

/** Whether the processor draws, because there is no graphics card. Smooth edges would then take most
 * of the time of a picture. */
function drawsInSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = gl ? gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER) : "";
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

export class View {
  /** `clicked(x, y)`: called for a click on the canvas. `drawn()`: called after each drawing. */
  constructor(scene, clicked, drawn) {
    this.canvas = byId("canvas");
    this.renderer = new three.WebGLRenderer({
      canvas: this.canvas, antialias: !drawsInSoftware(),
      preserveDrawingBuffer: true // for drawMore()
    });
    this.renderer.setClearColor(GROUND);
    this.camera = new three.PerspectiveCamera(50, 1, 0.01, 100);
    this.world = new three.Scene();
    this.cloud = new Cloud();
    this.mesh = new Mesh();
    this.cameras = new Cameras(scene.cameras, scene.view.radius / 6);
    this.mesh.group.visible = false;
    this.world.add(this.cloud.group, this.mesh.group, this.cameras.group);
    this.controls = new Controls(this.camera, this.canvas, () => this.move(), clicked);
    this.scene = scene;
    this.drawn = drawn;
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    this.resize();
    this.reset();
  }

  get size() { return [this.canvas.clientWidth, this.canvas.clientHeight]; }

  resize() {
    const [width, height] = [this.canvas.parentElement.clientWidth,
                             this.canvas.parentElement.clientHeight];
    if (!width || !height) return;
    this.ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.renderer.setPixelRatio(this.ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.move();
  }

  /** The whole reconstruction, seen in the mean direction of the photographs. */
  reset() {
    const { centre, radius, towards, up } = this.scene.view;
    this.controls.target.fromArray(centre);
    this.controls.up.fromArray(up);
    const narrow = Math.min(1, this.size[0] / Math.max(this.size[1], 1));
    const arm = new three.Vector3().fromArray(towards).multiplyScalar(-2.6 * radius / narrow);
    this.controls.place(arm.add(this.controls.target));
  }

  /** Looks from the place of a photograph. */
  lookFrom(camera, number) {
    const r = camera.rotation, forward = new three.Vector3(r[6], r[7], r[8]);
    const eye = new three.Vector3().fromArray(camera.centre);
    const depth = new three.Vector3().fromArray(this.scene.view.centre).sub(eye).dot(forward);
    this.cameras.choose(number);
    this.controls.up.set(-r[3], -r[4], -r[5]);
    this.controls.target.copy(eye).addScaledVector(forward, Math.max(depth, this.scene.view.radius / 4));
    this.controls.place(eye);
  }

  /** Looks at a place from near, in the direction of the last view. */
  lookAt(place) {
    const arm = this.camera.position.clone().sub(this.controls.target);
    this.controls.target.fromArray(place);
    this.controls.place(arm.setLength(this.scene.view.radius / 2).add(this.controls.target));
  }

  moving = 300000; // the most points while the view moves
  loading = true; // until the first call of rest()

  /** Draws the view after a change: some points at once, and all when the view stands still. */
  move() {
    clearTimeout(this.timer);
    cancelAnimationFrame(this.next);
    this.complete = false;
    this.asked ??= requestAnimationFrame(begin => {
      this.asked = null;
      this.cloud.show(0, this.moving);
      this.draw();
      requestAnimationFrame(end => { if (this.asked) this.adapt(end - begin); });
    });
    if (!this.loading) this.timer = setTimeout(() => this.rest(), STILL);
  }

  /** Chooses the number of points for the next picture while the view moves, by the time that the last
   * picture took [ms]. */
  adapt(time) {
    const factor = Math.min(Math.max(MOVING_TIME / time, 0.7), 1.05);
    this.moving = Math.min(Math.max(this.moving * factor, FEWEST), Math.max(this.cloud.points, FEWEST));
  }

  /** Draws all points, in portions, so that the page stays usable: computers without a graphics card
   * draw a thousand times more slowly. Called when all data are loaded, and when the view stands
   * still. Times a picture of the coarse levels. */
  rest() {
    this.loading = false;
    const points = Math.min(this.moving, this.cloud.points);
    this.cloud.show(0, points);
    this.drawAndWait(); // the first picture of a point also loads it to the graphics card
    const begin = performance.now();
    this.drawAndWait();
    const perPoint = (performance.now() - begin) / Math.max(points, 1);
    if (points > FEWEST) this.moving = Math.max(MOVING_TIME / 2 / perPoint, FEWEST);
    this.drawMore(points, Math.max(PORTION_TIME / perPoint, 50000));
  }

  // Adds the points from number `first` on to the picture, in portions.
  drawMore(first, portion) {
    this.complete = first >= this.cloud.points;
    if (this.complete) return;
    this.next = requestAnimationFrame(() => {
      this.cloud.show(first, first + portion);
      this.renderer.autoClear = false;
      this.draw();
      this.renderer.autoClear = true;
      this.drawMore(first + portion, portion);
    });
  }

  draw() {
    this.cloud.material.uniforms.size.value = this.pointSize * this.ratio;
    this.renderer.render(this.world, this.camera);
    this.drawn();
  }

  drawAndWait() {
    this.draw();
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  pointSize = 2;

  /** The place of a point of the scene on the canvas [CSS px], or null behind the eye. */
  screenOf(place) {
    const p = new three.Vector3().fromArray(place).applyMatrix4(this.camera.matrixWorldInverse);
    if (p.z >= 0) return null;
    p.applyMatrix4(this.camera.projectionMatrix);
    const [width, height] = this.size;
    return [(p.x + 1) * width / 2, (1 - p.y) * height / 2];
  }

  /** The point at (x, y) as { position, views, error }, or null: a point of the cloud, or of the mesh
   * if only the mesh is shown. A point of the mesh has the views of the nearest point of the cloud,
   * and no error. */
  pick(x, y) {
    if (this.cloud.group.visible) return this.cloud.pick(this.camera, ...this.size, x, y);
    if (!this.mesh.group.visible) return null;
    const [width, height] = this.size, caster = new three.Raycaster();
    caster.setFromCamera(new three.Vector2(2 * x / width - 1, 1 - 2 * y / height), this.camera);
    const position = this.mesh.pick(caster);
    return position && { position, error: null, views: this.cloud.nearest(position)?.views ?? null };
  }

  /** The share of the pixels that show something. For tests. */
  drawnShare() {
    const gl = this.renderer.getContext();
    const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    const read = scene => {
      this.renderer.render(scene, this.camera);
      gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    };
    read(new three.Scene());
    const ground = pixels.slice(0, 3);
    this.cloud.show(0, Infinity);
    this.draw();
    read(this.world);
    let shown = 0;
    for (let i = 0; i < pixels.length; i += 4)
      if (ground.some((value, k) => pixels[i + k] !== value)) ++shown;
    return shown / (pixels.length / 4);
  }
}
