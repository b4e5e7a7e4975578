// A one-mesh .glb made in memory, for engines that bring their materials with their glTF loader.
const FLOAT = 5126;
const UNSIGNED_INT = 5125;
const ARRAY_BUFFER = 34962;
const ELEMENT_ARRAY_BUFFER = 34963;

export function glb({ positions, indices }) {
  const json = {
    asset: { version: '2.0' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 0 }, indices: 1, material: 0 }] }],
    materials: [{ pbrMetallicRoughness: {} }],
    accessors: [
      { bufferView: 0, componentType: FLOAT, count: positions.length / 3, type: 'VEC3', min: [-1, -1, -1], max: [1, 1, 1] },
      { bufferView: 1, componentType: UNSIGNED_INT, count: indices.length, type: 'SCALAR' },
    ],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: positions.byteLength, target: ARRAY_BUFFER },
      { buffer: 0, byteOffset: positions.byteLength, byteLength: indices.byteLength, target: ELEMENT_ARRAY_BUFFER },
    ],
    buffers: [{ byteLength: positions.byteLength + indices.byteLength }],
  };
  const text = new TextEncoder().encode(padded(JSON.stringify(json)));
  const binary = positions.byteLength + indices.byteLength;
  const bytes = new Uint8Array(12 + 8 + text.length + 8 + binary);
  const header = new DataView(bytes.buffer);
  [0x46546c67, 2, bytes.length, text.length, 0x4e4f534a].forEach((word, i) => header.setUint32(4 * i, word, true));
  bytes.set(text, 20);
  const at = 20 + text.length;
  header.setUint32(at, binary, true);
  header.setUint32(at + 4, 0x004e4942, true);
  bytes.set(new Uint8Array(positions.buffer), at + 8);
  bytes.set(new Uint8Array(indices.buffer), at + 8 + positions.byteLength);
  return bytes;
}

/** Chunks are multiples of four bytes. */
function padded(text) {
  return text.padEnd(Math.ceil(text.length / 4) * 4);
}
