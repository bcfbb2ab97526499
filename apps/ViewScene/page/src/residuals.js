// SPDX-License-Identifier: GPL-3.0-or-later
// The tab "Residuals": reprojection errors over the image, and what causes their pattern.
import { drawArrows } from "./arrows.js";
import { rampLegend } from "./colours.js";
import { byId, make, table } from "./elements.js";

const count = value => value.toLocaleString("en-US");
const pixels = value => `${value.toFixed(value < 0.1 ? 3 : 2)} px`;
const percent = value => `${Math.round(100 * Math.max(value, 0))} %`;
const many = (number, thing) => `${count(number)} ${thing}${number === 1 ? "" : "s"}`;

const CLEAR = 0.5; // a cause that explains less of the pattern is not named
const POSES = 1.3; // times the error that the poses could reach: they do not fit
const NEAR = 0.1; // causes with nearly the share of the best

function listOf(texts) {
  return texts.length < 2 ? texts.join("") : `${texts.slice(0, -1).join(", ")} and ${texts.at(-1)}`;
}

const LENGTH = /^(distance|thickness|radius|focal)/; // names of numbers that are not negative
const value = (number, unit) => number.toFixed(unit ? 2 : 4);

export class Residuals {
  constructor(scene) {
    this.scene = scene;
    this.all = scene.residuals;
    this.photographs = [...this.all.photographs].sort((a, b) => b.rms - a.rms);
    const size = camera => camera.found ? camera.systematic : 0;
    const worst = this.all.cameras.reduce(
      (most, camera, k, cameras) => size(camera) > size(cameras[most]) ? k : most, 0);
    this.picture = make("div", { id: "residual-picture" });
    this.choice = make("select", { id: "residual-choice", "aria-label": "Camera or photograph",
                                   onchange: () => this.show() }, ...this.options());
    byId("residuals").replaceChildren(...this.verdict(),
      make("h2", {}, "Mean errors over the image"), this.choice, this.picture);
    this.choice.value = `camera ${worst}`;
    this.show();
  }

  /** The name of a camera: its number, and its port. */
  nameOf(number) {
    if (number === undefined) return "all cameras";
    const first = this.all.photographs.find(photograph => photograph.camera === number);
    const port = this.scene.cameras[first.number].port;
    return `camera ${number + 1} (${port ? `${port.kind} port ${port.name}` : "no port"})`;
  }

  options() {
    const named = this.all.cameras.map((camera, k) => {
      const photographs = this.all.photographs.filter(photograph => photograph.camera === k).length;
      return make("option", { value: `camera ${k}` },
                  `${this.nameOf(k)}: ${many(photographs, "photograph")}`.replace(/^c/, "C"));
    });
    const photographs = this.photographs.map((photograph, k) => make(
      "option", { value: `photograph ${k}` },
      `${this.scene.cameras[photograph.number].name}: ${pixels(photograph.rms)}`));
    return [make("optgroup", { label: "Cameras" }, ...named),
            make("optgroup", { label: "Photographs, largest error first" }, ...photographs)];
  }

  /** The judgement, in words. */
  verdict() {
    const { cameras, observations, unseen, rms, rms_freed: freed } = this.all;
    const posesFit = rms <= POSES * freed;
    const found = cameras.map((camera, k) => camera.found ? k : -1).filter(k => k >= 0);
    const tells = cameras.filter(camera => camera.tells);
    const parts = [table([["Error (RMS)", pixels(rms)], ["Observations", count(observations)],
                          ...unseen ? [["Without an image", count(unseen)]] : []], "number")];
    if (!posesFit)
      parts.unshift(make("p", { class: "verdict bad" }, "The poses do not fit the cameras: with the " +
        `pose of each photograph free, the error falls from ${pixels(rms)} to ${pixels(freed)}. ` +
        "They come from other cameras, or were not refined."));
    if (found.length)
      parts.unshift(make("p", { class: "verdict bad" }, `A systematic pattern in ${listOf(found.map(
        k => this.nameOf(k)))}. The errors are not noise alone: a port, a lens or the poses do not fit.`),
                    ...this.causes());
    else if (tells.length)
      parts.unshift(make("p", { class: `verdict ${posesFit ? "good" : ""}` },
        "No systematic pattern: the errors are noise of about " +
        `${pixels(Math.max(...tells.map(camera => camera.noise)))} per axis. ` +
        (posesFit ? "Ports and lenses fit the photographs, as far as tracks can tell." : "")));
    else
      parts.unshift(make("p", { class: "verdict" }, "Too few observations to tell noise from a pattern."));
    return parts;
  }

  causes() {
    const { causes } = this.all, [best] = causes;
    if (!best || best.share < CLEAR)
      return [make("p", { class: "cause" }, "No single number of a port or a lens explains the pattern. " +
        "Check the poses, the distortion of the lens and the kind of the port.")];
    const others = causes.slice(1).filter(cause => cause.share > best.share - NEAR &&
      !cause.numbers.some(number => best.numbers.some(other => other.name === number.name)));
    const also = others.length ? ` The ${[...new Set(others.map(cause => cause.name))].join(" or the ")} ` +
      "would explain it nearly as well." : "";
    const single = this.all.cameras.length === 1;
    const rows = causes.filter(cause => cause.share > 0.02).map(cause => [
      single ? cause.name : `${cause.name}, ${this.nameOf(cause.camera)}`, percent(cause.share)]);
    const title = `Likely cause: ${best.name}, ${this.nameOf(best.camera)}. `;
    return [make("p", { class: "cause" }, make("b", {}, title), this.explained(best), also),
            this.changes(best),
            make("details", {}, make("summary", {}, "What single changes would explain"), table(rows, "number"),
                 make("p", { class: "hint" }, "Shares of the squared pattern, by one linear step in " +
                   "which poses and points are free and the scale is kept."))];
  }

  explained({ name, share }) {
    const part = share > 0.985 ? "nearly all" : percent(share);
    return name.startsWith("a port")
      ? `Refraction, or a wrong radial distortion of the lens, explains ${part} of the pattern. ` +
        "For photographs under water, give the housing."
      : `The change below explains ${part} of the pattern.`;
  }

  /** The numbers that fit. One linear step does not find the numbers of a port that is missing. */
  changes(cause) {
    if (cause.name.startsWith("a port")) return "";
    return table([["", "given", "fits"], ...cause.numbers.map(
      ({ name, unit, stated, change, sigma }) => {
        const fits = Math.max(stated + change, LENGTH.test(name) ? 0 : -Infinity);
        return [unit ? `${name} [${unit}]` : name, value(stated, unit),
                `${value(fits, unit)} ± ${value(sigma, unit)}`];
      })], "number");
  }

  /** Draws the camera or the photograph that is chosen. */
  show() {
    const [kind, number] = this.choice.value.split(" ");
    const camera = kind === "camera";
    const shown = camera ? this.all.cameras[number] : this.photographs[number];
    const of = camera ? shown : this.all.cameras[shown.camera];
    const photo = camera ? null : this.scene.cameras[shown.number].photo;
    const { svg, longest, magnified } = drawArrows(shown.grid, of.size, of.noise, photo);
    const rows = [["Observations", count(shown.observations)], ["Error (RMS)", pixels(shown.rms)]];
    if (camera)
      rows.push(["Noise per axis", pixels(shown.noise)], ["Systematic part", pixels(shown.systematic)],
                ["χ² per degree of freedom", shown.degrees ?
                  `${(shown.chi_square / shown.degrees).toFixed(2)} (${shown.degrees})` : "–"],
                ["Pattern", !shown.tells ? "too few observations" : shown.found ? "yes" : "no"]);
    this.picture.replaceChildren(
      make("div", { class: "drawing" }, svg), rampLegend("0", pixels(longest)),
      make("p", { class: "hint" }, `Arrows from the projected to the observed pixel, magnified ` +
        `${magnified < 10 ? magnified.toPrecision(2) : Math.round(magnified)} times. Grey arrows are ` +
        "within two standard errors. " +
        (camera ? "The pose of each photograph is free." : "With the poses of the scene.")),
      table(rows, "number"));
  }
}
