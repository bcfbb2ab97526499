// SPDX-License-Identifier: GPL-3.0-or-later
// The tab "Measure": paths of picked points, their lengths and areas, saved as CSV.
import { byId, make, save, table } from "./elements.js";
import { areaOf, csv, quantity, segmentsOf, total } from "./measure.js";
import { surfaceOf } from "./volume.js";

export class Paths {
  /** `mesh`: for volumes. `changed`: called after each change. */
  constructor(scene, mesh, changed) {
    this.scene = scene;
    this.mesh = mesh;
    this.changed = changed;
    this.all = [[]];
    this.meshIsThere = false;
    byId("undo").onclick = () => this.removeLast();
    byId("next").onclick = () => { if (this.all.at(-1).length) this.all.push([]); this.show(); };
    byId("clear").onclick = () => { this.all = [[]]; this.show(); };
    byId("export").onclick = () => save("measurements.csv", this.csv());
    this.show();
  }

  add(place) {
    this.all.at(-1).push(place);
    this.all.at(-1).volumes = null;
    this.show();
  }

  removeLast() {
    if (!this.all.at(-1).length && this.all.length > 1) this.all.pop();
    this.all.at(-1).pop();
    this.all.at(-1).volumes = null;
    this.show();
  }

  /** Called when all parts of the mesh are loaded. */
  meshLoaded() {
    this.meshIsThere = true;
    this.show();
  }

  measureSurface(path) {
    path.volumes = surfaceOf(path, this.mesh.arrays(), this.scene.view.towards);
    this.show();
  }

  csv() {
    return csv(this.all.filter(path => path.length), this.scene.origin);
  }

  show() {
    const unit = this.scene.metric ? "m" : "";
    byId("paths").replaceChildren(...this.all.filter(path => path.length).map((path, number) => {
      const rows = segmentsOf(path).map(
        (value, k) => [`${k + 1} to ${k + 2}`, quantity(value, unit)]);
      if (path.length > 1) rows.push(["Length", quantity(total(path), unit)]);
      if (path.length > 2) rows.push(["Area", quantity(areaOf(path), unit, 2)]);
      const volumes = path.volumes;
      if (volumes)
        rows.push(["Mesh above the plane", quantity(volumes.above, unit, 3)],
                  ["Mesh below the plane", quantity(volumes.below, unit, 3)],
                  ["Surface of the mesh", quantity(volumes.surface, unit, 2)],
                  ["Rugosity (surface / plane)", rugosityText(volumes)],
                  ["Covered by the mesh", `${(100 * volumes.covered).toFixed(1)} %`]);
      const more = areaOf(path) > 0 && !volumes && this.scene.mesh
        ? [make("button", { class: "volume", disabled: !this.meshIsThere,
                            onclick: () => this.measureSurface(path) },
                this.meshIsThere ? "Volume and rugosity" : "The mesh is not loaded yet")] : [];
      return make("div", {}, make("h2", {}, `Path ${number + 1}: ${path.length} point` +
        (path.length === 1 ? "" : "s")), table(rows, "number"), ...more);
    }));
    this.changed();
  }
}

// A surface with holes has less area than the whole one.
function rugosityText({ rugosity, covered }) {
  return rugosity === null ? "–" : rugosity.toFixed(3) + (covered < 0.99 ? " of the covered part" : "");
}
