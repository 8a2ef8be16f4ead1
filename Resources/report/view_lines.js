// Lines of a width in pixels, which WebGL itself does not draw: a strip a segment, turned to the eye.

const LINE_VERTEX = `
  #include <clipping_planes_pars_vertex>
  attribute vec3 other;
  attribute float side;
  uniform vec2 size;
  uniform float width;
  uniform float nearer;
  void main() {
    vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * mvPosition;
    vec4 end = projectionMatrix * modelViewMatrix * vec4(other, 1.0);
    vec2 way = (end.xy - gl_Position.xy) * size;
    float far = length(way);
    way = far > 1e-6 ? way / far : vec2(1.0, 0.0);
    gl_Position.xy += side * vec2(-way.y, way.x) * width / size;
    gl_Position.z -= nearer;
    #include <clipping_planes_vertex>
  }`;

const LINE_FRAGMENT = `
  #include <clipping_planes_pars_fragment>
  uniform vec3 colour;
  void main() {
    #include <clipping_planes_fragment>
    gl_FragColor = vec4(colour, 1.0);
  }`;

class Lines {
  // ``width`` in pixels; ``planes``: what cuts them; ``nearer``: of the depth, by which they stand out.
  constructor(colour, width, planes, nearer = 2e-5) {
    this.uniforms = {
      colour: { value: new THREE.Color(colour) },
      size: { value: new THREE.Vector2(1, 1) },
      width: { value: width },
      nearer: { value: nearer },
    };
    const material = new THREE.ShaderMaterial({
      uniforms: this.uniforms,
      vertexShader: LINE_VERTEX,
      fragmentShader: LINE_FRAGMENT,
      side: THREE.DoubleSide,
      clipping: true,
      clippingPlanes: planes,
    });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.frustumCulled = false;
  }

  // ``ends``: 6 numbers a segment.
  set(ends) {
    const count = ends.length / 6;
    const position = new Float32Array(12 * count);
    const other = new Float32Array(12 * count);
    const side = new Float32Array(4 * count);
    const index = new Uint32Array(6 * count);
    for (let s = 0; s < count; s++) {
      const a = ends.slice(6 * s, 6 * s + 3);
      const b = ends.slice(6 * s + 3, 6 * s + 6);
      [a, a, b, b].forEach((point, k) => position.set(point, 12 * s + 3 * k));
      [b, b, a, a].forEach((point, k) => other.set(point, 12 * s + 3 * k));
      side.set([1, -1, -1, 1], 4 * s);
      index.set([0, 1, 2, 2, 1, 3].map((k) => 4 * s + k), 6 * s);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
    geometry.setAttribute("other", new THREE.BufferAttribute(other, 3));
    geometry.setAttribute("side", new THREE.BufferAttribute(side, 1));
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
    this.mesh.visible = count > 0;
  }

  resize(width, height) {
    this.uniforms.size.value.set(width, height);
  }
}

// Ends (6 numbers a segment) of edges between points, given by two numbers of points each.
function edgeEnds(points, edges) {
  const ends = new Float32Array(3 * edges.length);
  for (let i = 0; i < edges.length; i++) {
    for (let k = 0; k < 3; k++) ends[3 * i + k] = points[3 * edges[i] + k];
  }
  return ends;
}

// Where triangles cross the plane ``normal`` · p = ``place``: calls ``found(i, j, t)`` for both ends of each
// segment, which lie at t between the points i and j.
function crossings(points, triangles, normal, place, found) {
  const side = new Float32Array(points.length / 3);
  for (let i = 0; i < side.length; i++) {
    side[i] = points[3 * i] * normal[0] + points[3 * i + 1] * normal[1] + points[3 * i + 2] * normal[2] - place;
  }
  for (let t = 0; t < triangles.length; t += 3) {
    const above = [0, 1, 2].filter((k) => side[triangles[t + k]] > 0).length;
    if (above === 0 || above === 3) continue;
    for (let k = 0; k < 3; k++) {
      const i = triangles[t + k];
      const j = triangles[t + ((k + 1) % 3)];
      if (side[i] > 0 !== side[j] > 0) found(i, j, side[i] / (side[i] - side[j]));
    }
  }
}
