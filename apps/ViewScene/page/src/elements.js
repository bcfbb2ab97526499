// SPDX-License-Identifier: GPL-3.0-or-later
// Makes elements of the page.

export const byId = id => document.getElementById(id);

/** An element with attributes and children. A child may be a text. Values of attributes that begin
 * with "on" are functions; true gives an attribute without a value, false and null none. */
export function make(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (value !== false && value !== null) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children);
  return element;
}

/** An element of SVG with attributes and children. */
export function draw(name, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/** Saves a text as a file. */
export function save(name, text) {
  const link = make("a", { href: URL.createObjectURL(new Blob([text], { type: "text/csv" })),
                           download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** A table of rows; the first cell of a row is its title. */
export function table(rows, className = "") {
  return make("table", {}, ...rows.map(([title, ...cells]) => make(
    "tr", {}, make("th", { scope: "row" }, title),
    ...cells.map(cell => make("td", { class: className }, String(cell))))));
}
