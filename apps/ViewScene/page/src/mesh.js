// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh: parts with a texture each, with colours, or plain (libs/view/mesh_data.h).
import * as three from "three";

const PAINTED = `
  varying vec2 place;
  void main() {
    place = uv;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;
const TEXTURE = `
  uniform sampler2D map;
  varying vec2 place;
  void main() { gl_FragColor = vec4(texture2D(map, place).rgb, 1.0); }`;
const COLORED = `
  attribute vec3 color;
  varying vec3 shown;
  void main() {
    shown = color;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;
const COLOR = `
  varying vec3 shown;
  void main() { gl_FragColor = vec4(shown, 1.0); }`;

export class Mesh {
  constructor() {
    this.group = new three.Group();
    this.textures = [];
    this.parts = [];
  }

  /** Adds a texture: the bytes of a JPEG file. */
  async addTexture(bytes) {
    const image = await createImageBitmap(new Blob([bytes], { type: "image/jpeg" }));
    const texture = new three.Texture(image);
    texture.flipY = false;
    texture.anisotropy = 4;
    texture.needsUpdate = true;
    this.textures.push(texture);
  }

  add(entry, bytes) {
    const { vertices, faces } = entry;
    let at = bytes.byteOffset;
    const take = (Type, count) => {
      const values = new Type(bytes.buffer.slice(at, at + count * Type.BYTES_PER_ELEMENT));
      at += count * Type.BYTES_PER_ELEMENT;
      return values;
    };
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position",
                          new three.BufferAttribute(take(Float32Array, 3 * vertices), 3));
    geometry.setIndex(new three.BufferAttribute(take(Uint32Array, 3 * faces), 1));
    if (entry.texture >= 0)
      geometry.setAttribute("uv", new three.BufferAttribute(take(Uint16Array, 2 * vertices), 2, true));
    if (entry.colors)
      geometry.setAttribute("color", new three.BufferAttribute(take(Uint8Array, 3 * vertices), 3, true));
    const part = new three.Mesh(geometry, this.material(entry));
    this.parts.push(part);
    this.group.add(part);
  }

  // The colours of textures and vertices reach the screen as they are, like those of the cloud.
  material(entry) {
    const side = three.DoubleSide;
    if (entry.texture >= 0)
      return new three.ShaderMaterial({ side, vertexShader: PAINTED, fragmentShader: TEXTURE,
                                        uniforms: { map: { value: this.textures[entry.texture] } } });
    if (entry.colors)
      return new three.ShaderMaterial({ side, vertexShader: COLORED, fragmentShader: COLOR });
    return new three.MeshNormalMaterial({ flatShading: true, side });
  }

  /** The positions and the faces of all parts, for volumes. */
  arrays() {
    return this.parts.map(({ geometry }) => ({
      positions: geometry.getAttribute("position").array, indices: geometry.index.array }));
  }

  /** The point of the mesh at the place of `caster`, as [x, y, z], or null. */
  pick(caster) {
    const hit = caster.intersectObjects(this.parts, false)[0];
    return hit ? hit.point.toArray() : null;
  }
}
