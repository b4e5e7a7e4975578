// What every engine shows: a unit sphere at the origin, seen from distance 4 along the world's z axis with +Y up, by a
// camera whose square picture spans 30 degrees. `front` stands at +Z and looks along -Z, `back` the other way round.
export const DISTANCE = 4;
export const FIELD_OF_VIEW_DEGREES = 30;
export const NEAR = 1;
export const FAR = 10;

export function eye(view) {
  return [0, 0, view === 'front' ? DISTANCE : -DISTANCE];
}

/** Positions (which are the normals too) and triangles of a sphere fine enough that its normals err by 2e-5. */
export function sphere(columns = 512, rows = 256) {
  const positions = new Float32Array((columns + 1) * (rows + 1) * 3);
  for (let row = 0, at = 0; row <= rows; row++) {
    const polar = (Math.PI * row) / rows;
    for (let column = 0; column <= columns; column++) {
      const azimuth = (2 * Math.PI * column) / columns;
      positions[at++] = Math.sin(polar) * Math.cos(azimuth);
      positions[at++] = Math.cos(polar);
      positions[at++] = -Math.sin(polar) * Math.sin(azimuth);
    }
  }
  const indices = [];
  for (let row = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++) {
      const a = row * (columns + 1) + column;
      const b = a + columns + 1;
      indices.push(a, b, a + 1, a + 1, b, b + 1);
    }
  }
  return { positions, indices: new Uint32Array(indices) };
}
