// What a ray meets: triangles in blocks of neighbours, of which only those whose box it crosses are asked.

const BLOCK = 128; // triangles

class Body {
  constructor(points, triangles) {
    this.points = points;
    this.triangles = triangles;
    const count = Math.ceil(triangles.length / 3 / BLOCK);
    this.boxes = new Float32Array(6 * count);
    for (let b = 0; b < count; b++) {
      const low = [Infinity, Infinity, Infinity];
      const high = [-Infinity, -Infinity, -Infinity];
      const end = Math.min(3 * BLOCK * (b + 1), triangles.length);
      for (let i = 3 * BLOCK * b; i < end; i++) {
        for (let k = 0; k < 3; k++) {
          const value = points[3 * triangles[i] + k];
          low[k] = Math.min(low[k], value);
          high[k] = Math.max(high[k], value);
        }
      }
      this.boxes.set([...low, ...high], 6 * b);
    }
  }

  // {distance, triangle, point} of the nearest triangle that a ray meets where ``shown(point)``; null: none.
  hit(origin, direction, shown) {
    let best = null;
    const inverse = direction.map((d) => 1 / (d || 1e-30));
    for (let b = 0; b < this.boxes.length / 6; b++) {
      let near = 0;
      let far = best ? best.distance : Infinity;
      for (let k = 0; k < 3; k++) {
        const one = (this.boxes[6 * b + k] - 1e-4 - origin[k]) * inverse[k];
        const other = (this.boxes[6 * b + 3 + k] + 1e-4 - origin[k]) * inverse[k];
        near = Math.max(near, Math.min(one, other));
        far = Math.min(far, Math.max(one, other));
      }
      if (near > far) continue;
      const end = Math.min(BLOCK * (b + 1), this.triangles.length / 3);
      for (let t = BLOCK * b; t < end; t++) {
        const distance = this.crossing(t, origin, direction);
        if (distance === null || (best && distance >= best.distance)) continue;
        const point = origin.map((value, k) => value + distance * direction[k]);
        if (!shown || shown(point)) best = { distance, triangle: t, point };
      }
    }
    return best;
  }

  // Möller and Trumbore (1997), from either side.
  crossing(t, origin, direction) {
    const p = this.points;
    const [a, b, c] = [0, 1, 2].map((k) => 3 * this.triangles[3 * t + k]);
    const e1x = p[b] - p[a], e1y = p[b + 1] - p[a + 1], e1z = p[b + 2] - p[a + 2];
    const e2x = p[c] - p[a], e2y = p[c + 1] - p[a + 1], e2z = p[c + 2] - p[a + 2];
    const [dx, dy, dz] = direction;
    const hx = dy * e2z - dz * e2y, hy = dz * e2x - dx * e2z, hz = dx * e2y - dy * e2x;
    const volume = e1x * hx + e1y * hy + e1z * hz;
    if (Math.abs(volume) < 1e-20) return null;
    const sx = origin[0] - p[a], sy = origin[1] - p[a + 1], sz = origin[2] - p[a + 2];
    const u = (sx * hx + sy * hy + sz * hz) / volume;
    if (u < -1e-5 || u > 1.00001) return null;
    const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
    const v = (dx * qx + dy * qy + dz * qz) / volume;
    if (v < -1e-5 || u + v > 1.00001) return null;
    const distance = (e2x * qx + e2y * qy + e2z * qz) / volume;
    return distance > 1e-6 ? distance : null;
  }

  // The corner of a triangle that lies nearest to a point.
  nearest(triangle, point) {
    let best = -1;
    let least = Infinity;
    for (let k = 0; k < 3; k++) {
      const i = this.triangles[3 * triangle + k];
      const away = Math.hypot(...point.map((value, j) => value - this.points[3 * i + j]));
      if (away < least) [best, least] = [i, away];
    }
    return best;
  }
}
