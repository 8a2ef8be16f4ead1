// The camera: parallel, turned about an upright axis; and the hand on mouse, keys and touch screen.

const TURN = 0.0075; // radian a pixel
const STEEPEST = 0.5 * Math.PI;
const ZOOM = 1.0015; // a unit of the mouse wheel
const GLIDE = 380; // ms from place to place

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
const along = (a, b, t) => a.map((value, k) => value + t * b[k]);
const unit = (a) => a.map((value) => value / (Math.hypot(...a) || 1));

class Camera {
  // ``up``: what is upright, a unit vector; ``reach``: mm around the middle that must not be cut off.
  constructor(up, reach, changed) {
    this.up = up;
    const least = up.map(Math.abs);
    const axis = [0, 0, 0];
    axis[least.indexOf(Math.min(...least))] = 1;
    this.east = unit(cross(up, axis));
    this.north = cross(up, this.east);
    this.reach = reach;
    this.changed = changed;
    this.state = { azimuth: 0, elevation: 0, height: 1, target: [0, 0, 0] };
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
    this.size = [1, 1];
    this.gliding = 0;
  }

  // {out, right, upward}: unit vectors towards the eye, and of the picture.
  axes(state = this.state) {
    const [ca, sa] = [Math.cos(state.azimuth), Math.sin(state.azimuth)];
    const [ce, se] = [Math.cos(state.elevation), Math.sin(state.elevation)];
    const level = this.east.map((value, k) => ca * value + sa * this.north[k]);
    const out = level.map((value, k) => ce * value + se * this.up[k]);
    const upward = level.map((value, k) => -se * value + ce * this.up[k]);
    return { out, upward, right: cross(upward, out) };
  }

  // The angles from which one looks along a direction.
  towards(direction) {
    const out = unit(direction.map((value) => -value));
    const elevation = Math.asin(Math.max(-1, Math.min(1, dot(out, this.up))));
    const flat = [dot(out, this.east), dot(out, this.north)];
    const steep = Math.hypot(...flat) < 1e-6;
    const quarter = 0.5 * Math.PI; // from above, axes of the part lie along the picture's
    const azimuth = steep ? quarter * Math.round(this.state.azimuth / quarter) : Math.atan2(flat[1], flat[0]);
    return { elevation, azimuth };
  }

  // Height and target at which points (3 each) fill the picture but for a margin.
  fitting(angles, points, margin = 1.16) {
    const { right, upward } = this.axes({ ...this.state, ...angles });
    const low = [Infinity, Infinity];
    const high = [-Infinity, -Infinity];
    for (let i = 0; i < points.length; i += 3) {
      const point = [points[i], points[i + 1], points[i + 2]];
      [dot(point, right), dot(point, upward)].forEach((value, k) => {
        low[k] = Math.min(low[k], value);
        high[k] = Math.max(high[k], value);
      });
    }
    const aspect = this.size[0] / this.size[1];
    const height = margin * Math.max(high[1] - low[1], (high[0] - low[0]) / aspect, 1e-3);
    const target = along(
      right.map((value) => (0.5 * (low[0] + high[0])) * value), upward, 0.5 * (low[1] + high[1]));
    return { ...angles, height, target };
  }

  resize(width, height) {
    this.size = [Math.max(width, 1), Math.max(height, 1)];
    this.update();
  }

  update() {
    const { out, upward } = this.axes();
    const { height, target } = this.state;
    const half = 0.5 * height;
    const wide = (half * this.size[0]) / this.size[1];
    const away = 2 * this.reach + Math.hypot(...target);
    const c = this.camera;
    [c.left, c.right, c.top, c.bottom, c.near, c.far] = [-wide, wide, half, -half, 0, 2 * away];
    c.position.set(...along(target, out, away));
    c.up.set(...upward);
    c.lookAt(...target);
    c.updateProjectionMatrix();
    c.updateMatrixWorld();
    this.changed();
  }

  // Goes to another state, at once or gliding.
  go(goal, at_once = false) {
    cancelAnimationFrame(this.gliding);
    const from = { ...this.state };
    const to = { ...from, ...goal };
    to.azimuth = from.azimuth + Math.atan2(Math.sin(to.azimuth - from.azimuth), Math.cos(to.azimuth - from.azimuth));
    if (at_once || matchMedia("(prefers-reduced-motion: reduce)").matches) {
      this.state = to;
      this.update();
      return;
    }
    const begin = performance.now();
    const step = (now) => {
      const share = Math.min(Math.max((now - begin) / GLIDE, 0), 1);
      const t = share * share * (3 - 2 * share);
      const between = (a, b) => a + t * (b - a);
      this.state = {
        azimuth: between(from.azimuth, to.azimuth),
        elevation: between(from.elevation, to.elevation),
        height: from.height * Math.pow(to.height / from.height, t),
        target: from.target.map((value, k) => between(value, to.target[k])),
      };
      this.update();
      if (share < 1) this.gliding = requestAnimationFrame(step);
    };
    this.gliding = requestAnimationFrame(step);
  }

  // {origin, direction} of the ray through a pixel of the canvas.
  ray(x, y) {
    const { out, right, upward } = this.axes();
    const scale = this.state.height / this.size[1];
    let point = along(this.state.target, right, (x - 0.5 * this.size[0]) * scale);
    point = along(point, upward, (0.5 * this.size[1] - y) * scale);
    const away = 2 * this.reach + Math.hypot(...this.state.target);
    return { origin: along(point, out, away), direction: out.map((value) => -value) };
  }

  // The pixel [x, y] at which a point is drawn.
  pixel(point) {
    const { right, upward } = this.axes();
    const away = along(point, this.state.target, -1);
    const scale = this.size[1] / this.state.height;
    return [0.5 * this.size[0] + dot(away, right) * scale, 0.5 * this.size[1] - dot(away, upward) * scale];
  }

  turn(dx, dy) {
    const { azimuth, elevation } = this.state;
    this.set({
      azimuth: azimuth - TURN * dx,
      elevation: Math.max(-STEEPEST, Math.min(STEEPEST, elevation + TURN * dy)),
    });
  }

  shift(dx, dy) {
    const { right, upward } = this.axes();
    const scale = this.state.height / this.size[1];
    this.set({ target: along(along(this.state.target, right, -dx * scale), upward, dy * scale) });
  }

  // What lies at the pixel stays there.
  zoom(factor, x = 0.5 * this.size[0], y = 0.5 * this.size[1]) {
    const height = Math.max(1e-4 * this.reach, Math.min(20 * this.reach, this.state.height * factor));
    const scale = (this.state.height - height) / this.size[1];
    const { right, upward } = this.axes();
    let target = along(this.state.target, right, (x - 0.5 * this.size[0]) * scale);
    target = along(target, upward, (0.5 * this.size[1] - y) * scale);
    this.set({ height, target });
  }

  set(part) {
    cancelAnimationFrame(this.gliding);
    Object.assign(this.state, part);
    this.update();
  }
}

// Mouse, touch and keys on the canvas. ``always``: the mouse wheel zooms at once; else, as the page must go
// on scrolling, once the canvas was clicked. ``on``: {home, centre(x, y), point(x, y), leave(), press(x, y)}.
function steer(canvas, camera, always, on) {
  const fingers = new Map();
  let moved = 0;
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, place(event));
    moved = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    const now = place(event);
    const before = fingers.get(event.pointerId);
    if (!before) {
      if (event.pointerType !== "touch") on.point(...now);
      return;
    }
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    moved += Math.abs(dx) + Math.abs(dy);
    if (fingers.size === 2) {
      const other = [...fingers.entries()].find(([id]) => id !== event.pointerId)[1];
      const span = (a) => Math.max(Math.hypot(a[0] - other[0], a[1] - other[1]), 1);
      camera.shift(0.5 * dx, 0.5 * dy);
      camera.zoom(span(before) / span(now), 0.5 * (now[0] + other[0]), 0.5 * (now[1] + other[1]));
    } else if (event.shiftKey || event.ctrlKey || event.buttons & 6) {
      camera.shift(dx, dy);
    } else {
      camera.turn(dx, dy);
    }
    if (moved > 3) on.leave();
    fingers.set(event.pointerId, now);
  });
  const release = (event) => {
    if (fingers.delete(event.pointerId) && moved <= 3 && event.type === "pointerup") on.press(...place(event));
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", () => on.leave());
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("dblclick", (event) => on.centre(...place(event)));
  canvas.addEventListener(
    "wheel",
    (event) => {
      if (!always && document.activeElement !== canvas && !document.fullscreenElement) return;
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 30 : 1;
      camera.zoom(Math.pow(ZOOM, Math.max(-300, Math.min(300, lines * event.deltaY))), ...place(event));
    },
    { passive: false }
  );
  const keys = {
    ArrowLeft: () => camera.turn(20, 0),
    ArrowRight: () => camera.turn(-20, 0),
    ArrowUp: () => camera.turn(0, 20),
    ArrowDown: () => camera.turn(0, -20),
    "+": () => camera.zoom(0.85),
    "-": () => camera.zoom(1 / 0.85),
    Home: () => on.home(),
    h: () => on.home(),
  };
  canvas.addEventListener("keydown", (event) => {
    if (!keys[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    keys[event.key]();
  });
}
