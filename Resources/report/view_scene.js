// What is drawn: the ground faces in their colours, the rest of the part, its edges, a section, the wheel.

const PART = 0xb9bdc3; // as in the report's pictures
const INSIDE = 0x7d848e; // of a solid, where it is cut open
const WAITING = 0x9a9da2; // not yet finished by the wheel
const MISSED = 0x707070; // that of core.deviation_colours
const LINE = 0x2c3036;
const GROUND = 0xd9008c; // in none of the scales
const NEVER_AGAIN = 1e9; // a motion after all others
const AROUND = 96; // corners of the wheel

const FIELD_VERTEX = `
  #include <clipping_planes_pars_vertex>
  attribute float value;
  attribute float known;
  attribute float last;
  varying float vValue;
  varying float vKnown;
  varying float vLast;
  void main() {
    vValue = value;
    vKnown = known;
    vLast = last;
    #include <begin_vertex>
    #include <project_vertex>
    #include <clipping_planes_vertex>
  }`;

// Without light: a colour says the same from every side.
const FIELD_FRAGMENT = `
  #include <clipping_planes_pars_fragment>
  uniform sampler2D scale;
  uniform vec3 missing;
  uniform vec3 inside;
  uniform vec3 waiting;
  uniform float solid;
  uniform float now;
  varying float vValue;
  varying float vKnown;
  varying float vLast;
  void main() {
    #include <clipping_planes_fragment>
    vec3 colour = vKnown < 0.999 ? missing : texture2D(scale, vec2(vValue, 0.5)).rgb;
    if (vLast > now) colour = waiting;
    if (solid > 0.5 && !gl_FrontFacing) colour = inside;
    gl_FragColor = vec4(colour, 1.0);
  }`;

class Scene {
  constructor(canvas, result) {
    this.result = result;
    const { about } = result;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setClearColor(0, 0);
    this.renderer.localClippingEnabled = true;
    this.plane = new THREE.Plane(new THREE.Vector3(0, 0, 1), Infinity);
    this.cut = null; // {normal, place, side}: kept is where side * (normal · p - place) <= 0
    this.planes = [];
    this.scene = new THREE.Scene();
    this.edges = new Lines(LINE, 1.3, this.planes);
    this.designLine = new Lines(LINE, 2.2, [], 4e-5);
    this.groundLine = new Lines(GROUND, 2.6, [], 6e-5);
    this.lines = [this.edges, this.designLine, this.groundLine];
    for (const line of this.lines) this.scene.add(line.mesh);
    this.designLine.set([]);
    this.groundLine.set([]);
    this.addField();
    this.addRest(about.solid);
    const outline = edgeEnds(result.ground, result.arrays.borders);
    const creases = edgeEnds(result.rest, result.arrays["rest.creases"]);
    const edges = new Float32Array(outline.length + creases.length);
    edges.set(outline);
    edges.set(creases, outline.length);
    this.edges.set(edges);
    this.addLight();
    this.wheel = about.wheel ? this.addWheel(about.wheel) : null;
    this.bodies = [new Body(result.ground, result.triangles), new Body(result.rest, result.restTriangles)];
  }

  addField() {
    const { ground, triangles, about, arrays } = this.result;
    const count = ground.length / 3;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(ground, 3));
    this.values = new THREE.BufferAttribute(new Float32Array(count), 1);
    this.known = new THREE.BufferAttribute(new Float32Array(count), 1);
    const last = new Float32Array(about.traced ? arrays["motion.last"] : count);
    geometry.setAttribute("value", this.values);
    geometry.setAttribute("known", this.known);
    geometry.setAttribute("last", new THREE.BufferAttribute(last, 1));
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    this.uniforms = {
      scale: { value: null },
      missing: { value: new THREE.Color(MISSED) },
      inside: { value: new THREE.Color(INSIDE) },
      waiting: { value: new THREE.Color(WAITING) },
      solid: { value: about.solid ? 1 : 0 },
      now: { value: NEVER_AGAIN },
    };
    const material = new THREE.ShaderMaterial({
      uniforms: this.uniforms,
      vertexShader: FIELD_VERTEX,
      fragmentShader: FIELD_FRAGMENT,
      side: THREE.DoubleSide,
      clipping: true,
      clippingPlanes: this.planes,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    this.scene.add(mesh);
  }

  addRest(solid) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.result.rest, 3));
    geometry.setIndex(new THREE.BufferAttribute(this.result.restTriangles, 1));
    if (!this.result.rest.length) return;
    geometry.computeVertexNormals();
    const more = { clippingPlanes: this.planes, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
    const outside = new THREE.MeshLambertMaterial({
      color: PART, side: solid ? THREE.FrontSide : THREE.DoubleSide, ...more });
    const meshes = [new THREE.Mesh(geometry, outside)];
    if (solid) {
      const inside = new THREE.MeshBasicMaterial({ color: INSIDE, side: THREE.BackSide, ...more });
      meshes.push(new THREE.Mesh(geometry, inside));
    }
    for (const mesh of meshes) {
      mesh.frustumCulled = false;
      this.scene.add(mesh);
    }
  }

  addLight() {
    this.sun = new THREE.DirectionalLight(0xffffff, 0.52); // from the eye's left shoulder
    this.sun.target = new THREE.Object3D();
    this.scene.add(this.sun, this.sun.target, new THREE.AmbientLight(0xffffff, 0.46));
  }

  // The wheel in the contact's frame: its axis along y, its middle at z = -R.
  addWheel(about) {
    const around = Array.from({ length: AROUND + 1 }, (_, k) => (2 * Math.PI * k) / AROUND);
    const rim = about.profile;
    const line = [[rim[0][0], 0], ...rim, [rim[rim.length - 1][0], 0]];
    const position = [];
    const index = [];
    line.forEach(([y, r], row) => {
      for (const a of around) position.push(r * Math.sin(a), y, r * Math.cos(a) - about.radius);
      if (row === 0) return;
      for (let k = 0; k < AROUND; k++) {
        const [a, b] = [(row - 1) * (AROUND + 1) + k, row * (AROUND + 1) + k];
        index.push(a, b, a + 1, b, b + 1, a + 1);
      }
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(position), 3));
    geometry.setIndex(index);
    geometry.computeVertexNormals();
    const body = new THREE.MeshLambertMaterial({
      color: 0x4d78a8, transparent: true, opacity: 0.32, depthWrite: false, side: THREE.DoubleSide });
    const edges = new Lines(0x24425f, 1.4, []);
    const ends = [];
    for (const [y, r] of [rim[0], rim[rim.length - 1]]) {
      const ring = around.map((a) => [r * Math.sin(a), y, r * Math.cos(a) - about.radius]);
      for (let k = 0; k < AROUND; k++) ends.push(...ring[k], ...ring[k + 1]);
    }
    edges.set(new Float32Array(ends));
    this.lines.push(edges);
    const group = new THREE.Group();
    group.add(new THREE.Mesh(geometry, body), edges.mesh);
    group.visible = false;
    this.scene.add(group);
    return group;
  }

  // The wheel at a frame: [x, y, z] about the middle and a quaternion [w, x, y, z]; null hides it.
  placeWheel(frame) {
    if (!this.wheel) return;
    this.wheel.visible = frame !== null;
    if (!frame) return;
    this.wheel.position.set(...frame.place);
    const [w, x, y, z] = frame.turn;
    this.wheel.quaternion.set(x, y, z, w);
  }

  // Grey is what a motion after ``motion`` removes last from; null: nothing.
  setNow(motion) {
    this.uniforms.now.value = motion === null ? NEVER_AGAIN : motion + 0.5;
  }

  colour(mode) {
    const codes = this.result.arrays[mode.values];
    const { low, high, colours } = mode.scale;
    for (let i = 0; i < codes.length; i++) {
      const value = decoded(codes[i], mode.low, mode.high);
      this.known.array[i] = Number.isNaN(value) ? 0 : 1;
      this.values.array[i] = Number.isNaN(value) ? 0 : (value - low) / (high - low);
    }
    this.values.needsUpdate = this.known.needsUpdate = true;
    const texels = new Uint8Array(4 * colours.length);
    colours.forEach((colour, k) => {
      const packed = parseInt(colour, 16);
      texels.set([packed >> 16, (packed >> 8) & 255, packed & 255, 255], 4 * k);
    });
    if (this.uniforms.scale.value) this.uniforms.scale.value.dispose();
    const texture = new THREE.DataTexture(texels, colours.length, 1, THREE.RGBAFormat);
    texture.needsUpdate = true; // nearest texel, clamped to the ends
    this.uniforms.scale.value = texture;
  }

  // Cuts away what lies beyond a plane, null: nothing; draws its lines, the deviation ``times`` as large.
  section(cut, times = 1) {
    this.cut = cut;
    this.planes.length = 0;
    if (!cut) {
      this.designLine.set([]);
      this.groundLine.set([]);
      return;
    }
    const { normal, place, side } = cut;
    this.plane.normal.set(...normal.map((value) => -side * value));
    this.plane.constant = side * place;
    this.planes.push(this.plane);
    const { design, heights, normals, triangles, rest, restTriangles } = this.result;
    const designed = [];
    const ground = [];
    const between = (values, i, j, t) =>
      [0, 1, 2].map((k) => values[3 * i + k] + t * (values[3 * j + k] - values[3 * i + k]));
    crossings(design, triangles, normal, place, (i, j, t) => {
      const point = between(design, i, j, t);
      const height = heights[i] + t * (heights[j] - heights[i]);
      let way = between(normals, i, j, t);
      way = along(way, normal, -dot(way, normal));
      designed.push(...point);
      ground.push(...along(point, way, times * height));
    });
    crossings(rest, restTriangles, normal, place, (i, j, t) => designed.push(...between(rest, i, j, t)));
    this.designLine.set(new Float32Array(designed));
    this.groundLine.set(new Float32Array(ground));
  }

  // Whether a point is not cut away.
  shown(point) {
    return !this.cut || this.cut.side * (dot(this.cut.normal, point) - this.cut.place) <= 1e-6;
  }

  // What a ray meets first: {distance, point, sample}; sample -1 beside the ground faces; null: nothing.
  pick({ origin, direction }) {
    const [ground, rest] = this.bodies.map((body) => body.hit(origin, direction, (point) => this.shown(point)));
    if (!ground && !rest) return null;
    if (!ground || (rest && rest.distance < ground.distance - 1e-4)) return { ...rest, sample: -1 };
    return { ...ground, sample: this.bodies[0].nearest(ground.triangle, ground.point) };
  }

  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setSize(width, height, false);
    for (const line of this.lines) line.resize(width, height);
  }

  draw(camera) {
    const { out, right, upward } = camera.axes();
    const from = out.map((value, k) => value - 0.45 * right[k] + 0.55 * upward[k]);
    this.sun.position.set(...from);
    this.renderer.render(this.scene, camera.camera);
  }
}
