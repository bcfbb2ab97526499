// SPDX-License-Identifier: GPL-3.0-or-later
// The tab "Run": the steps of `reconstruct`, their times, commands, versions and warnings.
import { byId, make } from "./elements.js";

function duration(seconds) {
  if (seconds < 60) return `${seconds.toFixed(1)} s`;
  const whole = Math.round(seconds), minutes = Math.floor(whole / 60);
  return minutes < 60 ? `${minutes} min ${whole % 60} s`
    : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

// A word of a command as a shell reads it.
const quoted = word => /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\"'\"'")}'`;

const folded = (title, words) => make("details", {}, make("summary", {}, title),
                                      make("code", {}, words.map(quoted).join(" ")));

function rowsOf(step) {
  const warnings = step.warnings.map(({ text, times }) => make(
    "li", {}, times > 1 ? `${text} (${times} times)` : text));
  return [
    make("tr", { class: "step" }, make("th", { scope: "row" }, step.name),
         make("td", { class: "number" }, duration(step.seconds))),
    make("tr", {}, make("td", { colspan: 2 }, folded(step.version ?? "Version not known", step.command),
                        ...warnings.length ? [make("ul", { class: "warnings" }, ...warnings)] : []))];
}

const inMillimetres = numbers => numbers.map(number => number === null ? "–" : number.toFixed(2)).join(", ");

// The table of bars and control points.
function controlTable(rows) {
  const cells = (kind, words) => words.map((word, i) => make(kind, i > 1 ? { class: "number" } : {}, word));
  return [
    make("h2", {}, "Bars and control points"),
    make("p", { class: "hint" }, "Found minus stated, and the standard deviation that this difference should have; " +
      "of points in x, y and z."),
    make("table", { id: "control" },
         make("tr", {}, ...cells("th", ["", "use", "photographs", "off [mm]", "expected [mm]"])),
         ...rows.map(row => make("tr", {}, ...cells("td", [
           row.name, row.use, String(row.photographs), inMillimetres(row.residual_mm),
           inMillimetres(row.expected_sigma_mm)]))))];
}

/** Shows scene.run. */
export function showRun({ command, steps, control }) {
  const warnings = steps.reduce((sum, step) => sum + step.warnings.length, 0);
  const seconds = steps.reduce((sum, step) => sum + step.seconds, 0);
  byId("run").replaceChildren(
    make("h2", {}, `${steps.length} steps in ${duration(seconds)}`),
    make("p", { class: "hint" }, `${warnings === 1 ? "1 warning" : `${warnings || "No"} warnings`}. Open a version ` +
      "to see the command."),
    folded("reconstruct", command), ...control?.length ? controlTable(control) : [],
    make("table", {}, ...steps.flatMap(rowsOf)));
}
