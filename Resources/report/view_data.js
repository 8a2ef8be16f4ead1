// The result's arrays, as reporting/view_mesh.py packed them.

const STEPS = 65534; // of a quantised value
const MISSING = 65535;

// {name: typed array} of the packed text; rows one after the other.
async function unpack(text, index) {
  if (typeof DecompressionStream === "undefined") {
    throw new Error("DecompressionStream (Chromium 80, Firefox 113, Safari 16.4)");
  }
  const letters = atob(text);
  const packed = new Uint8Array(letters.length);
  for (let i = 0; i < packed.length; i++) packed[i] = letters.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const kinds = { u1: Uint8Array, u2: Uint16Array, u4: Uint32Array };
  const found = {};
  for (const [name, [kind, rows, columns, first]] of Object.entries(index)) {
    const values = new kinds[kind](rows * columns);
    const size = values.BYTES_PER_ELEMENT;
    for (let column = 0; column < columns; column++) {
      const begin = first + column * rows * size;
      let value = 0;
      for (let row = 0; row < rows; row++) {
        let code = 0;
        for (let k = size - 1; k >= 0; k--) code = (code << 8) | bytes[begin + k * rows + row];
        value = (value + ((code >>> 1) ^ -(code & 1))) | 0; // the array keeps its own lowest bits
        values[row * columns + column] = value;
      }
    }
    found[name] = values;
  }
  return found;
}

// Coordinates (3 a point) in a box, about ``middle``, mm.
function inBox(codes, [low, high], middle) {
  const found = new Float32Array(codes.length);
  const step = low.map((value, k) => (high[k] - value) / STEPS);
  for (let i = 0; i < codes.length; i++) {
    const k = i % 3;
    found[i] = low[k] - middle[k] + step[k] * codes[i];
  }
  return found;
}

function decoded(code, low, high) {
  return code === MISSING ? NaN : low + ((high - low) * code) / STEPS;
}

// Unit vectors (3 each) from octahedral codes (2 each).
function unitVectors(codes) {
  const found = new Float32Array((codes.length / 2) * 3);
  for (let i = 0; i < codes.length / 2; i++) {
    let x = codes[2 * i] / 127 - 1;
    let y = codes[2 * i + 1] / 127 - 1;
    const z = 1 - Math.abs(x) - Math.abs(y);
    if (z < 0) {
      const before = x;
      x = (1 - Math.abs(y)) * (before >= 0 ? 1 : -1);
      y = (1 - Math.abs(before)) * (y >= 0 ? 1 : -1);
    }
    const length = Math.hypot(x, y, z) || 1;
    found.set([x / length, y / length, z / length], 3 * i);
  }
  return found;
}

// Corners of triangles, whose second and third were packed as distances from the first.
function corners(packed) {
  const found = new Uint32Array(packed);
  for (let i = 0; i < found.length; i += 3) {
    found[i + 1] += found[i];
    found[i + 2] += found[i];
  }
  return found;
}

// A result's samples and what is around them. Coordinates are about ``middle``.
function resultOf(about, arrays) {
  const [low, high] = about.box;
  const middle = low.map((value, k) => 0.5 * (value + high[k]));
  const design = inBox(arrays.points, about.box, middle);
  const normals = unitVectors(arrays.normals);
  // Beside sharp edges heights go along rays that lean, and are square to the face all the same.
  if (arrays.cosines) {
    for (let i = 0; i < normals.length; i++) normals[i] *= 255 / arrays.cosines[Math.floor(i / 3)];
  }
  const deviation = about.modes[0];
  const codes = arrays[deviation.values];
  const ground = new Float32Array(design);
  const heights = new Float32Array(codes.length);
  for (let i = 0; i < codes.length; i++) {
    const height = decoded(codes[i], deviation.low, deviation.high) || 0; // 0 where nothing is known
    heights[i] = height;
    for (let k = 0; k < 3; k++) ground[3 * i + k] += height * normals[3 * i + k];
  }
  return {
    about,
    arrays,
    middle,
    radius: 0.5 * Math.hypot(...low.map((value, k) => high[k] - value)) + about.top || 1,
    design,
    normals,
    heights,
    ground,
    triangles: corners(arrays.triangles),
    rest: inBox(arrays["rest.points"], about.box, middle),
    restTriangles: corners(arrays["rest.triangles"]),
    value: (mode, i) => decoded(arrays[mode.values][i], mode.low, mode.high),
  };
}
