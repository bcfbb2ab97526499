// SPDX-License-Identifier: GPL-3.0-or-later
// The tab "Measure": paths of picked points, their lengths and areas, saved as CSV.
import { byId, make, table } from "./elements.js";
import { areaOf, csv, quantity, segmentsOf, total } from "./measure.js";

export class Paths {
  /** `changed`: called after each change. */
  constructor(scene, changed) {
    this.scene = scene;
    this.changed = changed;
    this.all = [[]];
    byId("undo").onclick = () => this.removeLast();
    byId("next").onclick = () => { if (this.all.at(-1).length) this.all.push([]); this.show(); };
    byId("clear").onclick = () => { this.all = [[]]; this.show(); };
    byId("export").onclick = () => save("measurements.csv", this.csv());
    this.show();
  }

  add(place) {
    this.all.at(-1).push(place);
    this.show();
  }

  removeLast() {
    if (!this.all.at(-1).length && this.all.length > 1) this.all.pop();
    this.all.at(-1).pop();
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
      return make("div", {}, make("h2", {}, `Path ${number + 1}: ${path.length} point` +
        (path.length === 1 ? "" : "s")), table(rows, "number"));
    }));
    this.changed();
  }
}

function save(name, text) {
  const link = make("a", { href: URL.createObjectURL(new Blob([text], { type: "text/csv" })),
                           download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
