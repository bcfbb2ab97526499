// SPDX-License-Identifier: GPL-3.0-or-later
// The profile of heights along a path on the map: a chart, and a table as CSV.
import { draw, make, save } from "./elements.js";

const WIDTH = 340, HEIGHT = 150, LEFT = 50, RIGHT = 8, TOP = 10, BOTTOM = 32; // of the chart
const MOST = 400; // samples along the whole path

/** Samples [{ along, place, height }] along the path, at its points and between them at most `step` apart, or as far
 * as MOST samples allow. `along`: horizontal distance from the begin [m]; `height`: null where there is none. */
export function profileOf(path, heights, step) {
  const places = path.map(point => point.place), samples = [];
  const lengths = places.slice(1).map(([x, y], k) => Math.hypot(x - places[k][0], y - places[k][1]));
  const apart = Math.max(step, lengths.reduce((sum, length) => sum + length, 0) / MOST);
  let begin = 0;
  const add = (along, place) => samples.push({ along, place, height: heights.at(place) });
  lengths.forEach((length, k) => {
    const count = Math.max(1, Math.ceil(length / apart - 1e-9));
    for (let i = 0; i < count; ++i) {
      const share = i / count;
      add(begin + share * length, [0, 1].map(axis => (1 - share) * places[k][axis] + share * places[k + 1][axis]));
    }
    begin += length;
  });
  add(begin, places.at(-1));
  return samples;
}

// Runs of samples with a height: a line does not bridge a gap.
function runsOf(samples) {
  const runs = [[]];
  for (const sample of samples) {
    if (sample.height === null) runs.push([]);
    else runs.at(-1).push(sample);
  }
  return runs.filter(run => run.length > 1);
}

function chart(samples, low, high) {
  const long = samples.at(-1).along || 1, range = Math.max(high - low, 1e-3);
  const x = along => LEFT + (WIDTH - LEFT - RIGHT) * along / long;
  const y = height => HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (height - low) / range;
  const text = (at, words, anchor) => draw("text", { x: at[0], y: at[1], "text-anchor": anchor }, words);
  return draw("svg", { id: "profile", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img",
                       "aria-label": "Heights along the path" },
              draw("path", { class: "axes", d: `M${LEFT},${TOP}V${HEIGHT - BOTTOM}H${WIDTH - RIGHT}` }),
              ...runsOf(samples).map(run => draw("polyline", {
                points: run.map(({ along, height }) => `${x(along).toFixed(1)},${y(height).toFixed(1)}`).join(" ") })),
              text([LEFT - 4, y(low)], low.toFixed(3), "end"),
              text([LEFT - 4, TOP + 8], (low + range).toFixed(3), "end"),
              text([LEFT, HEIGHT - 16], "0", "start"), text([WIDTH - RIGHT, HEIGHT - 16], long.toFixed(2), "end"),
              text([(LEFT + WIDTH - RIGHT) / 2, HEIGHT - 3], "along the path [m]; heights [m]", "middle"));
}

/** The table of a profile. */
export const csvOf = samples => ["along,x,y,height", ...samples.map(({ along, place, height }) => [
  along.toFixed(4), ...place.map(value => value.toFixed(4)), height === null ? "" : height.toFixed(4)].join(","))]
  .join("\n") + "\n";

/** The elements of the profile of a path; none for fewer than two points or without a height. */
export function showProfile(path, heights) {
  if (path.length < 2 || !heights.entry) return [];
  const samples = profileOf(path, heights, heights.entry.place[2] / heights.entry.size[0]);
  const known = samples.map(sample => sample.height).filter(height => height !== null);
  if (!known.length) return [];
  return [make("h2", {}, "Profile"), chart(samples, Math.min(...known), Math.max(...known)),
          make("button", { id: "profile-save", onclick: () => save("profile.csv", csvOf(samples)) }, "Save profile")];
}
