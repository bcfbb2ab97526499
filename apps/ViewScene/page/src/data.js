// SPDX-License-Identifier: GPL-3.0-or-later
// Loads the data files. A page that was opened from the disk may not fetch files, but it may load
// scripts. So each data file is a script that calls functions of `axialData`.

const waiting = new Map(); // from "cloud 12" to the function that receives its bytes

function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

let description = null;
globalThis.axialData = {
  scene: value => { description = value; },
  put: (kind, number, text) => {
    try {
      waiting.get(`${kind} ${number}`)?.(bytesOf(text));
      waiting.delete(`${kind} ${number}`);
    } catch (error) {
      console.warn(error); // loadAll() reports the entry, which is still waiting
    }
  }
};

function load(file) {
  return new Promise((resolve, reject) => {
    const script = document.createElement("script");
    script.src = file;
    script.onload = () => { script.remove(); resolve(); };
    script.onerror = () => reject(new Error(`${file} cannot be read`));
    document.head.append(script);
  });
}

/** The description of the scene, the file data/scene.js. */
export async function loadScene() {
  await load("data/scene.js");
  if (!description) throw new Error("data/scene.js is damaged");
  return description;
}

/** Loads the entries of `list`, in its order, and calls receive(entry, bytes) for each. An entry
 * names its file; consecutive entries may share one. Throws an Error that names the file if it
 * cannot be read or lacks an entry. */
export async function loadAll(kind, list, receive) {
  list.forEach((entry, k) => waiting.set(`${kind} ${k}`, bytes => receive(entry, bytes)));
  for (const file of new Set(list.map(entry => entry.file))) {
    await load(file);
    if (list.some((entry, k) => entry.file === file && waiting.has(`${kind} ${k}`)))
      throw new Error(`${file} is damaged: write the page again`);
  }
}
