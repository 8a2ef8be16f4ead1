// The view in its page: starts where there is WebGL, and joins controls and scene.

const SLOWEST = 60; // s that the playback takes at most
const FASTEST = 8; // s that it takes at least

async function start() {
  const find = (id) => document.getElementById("view-" + id);
  const view = document.getElementById("view");
  const about = JSON.parse(find("about").textContent);
  const canvas = view.querySelector("canvas");
  const probe = document.createElement("canvas");
  if (!(probe.getContext("webgl") || probe.getContext("experimental-webgl"))) return; // the pictures remain
  const result = resultOf(about, await unpack(find("arrays").textContent, about.arrays));
  view.hidden = false;
  const { texts } = about;
  const number = numberIn(about.language);
  const scene = new Scene(canvas, result);
  let waiting = false;
  const reach = result.radius + (about.wheel ? 2.5 * about.wheel.radius : 0);
  const camera = new Camera(about.camera.up, reach, () => redraw());

  function redraw() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      scene.draw(camera);
      placeMarks();
      drawAxes();
    });
  }

  // --- camera
  const all = new Float32Array(result.ground.length + result.rest.length);
  all.set(result.ground);
  all.set(result.rest, result.ground.length);
  const fit = (direction, now) => camera.go(camera.fitting(camera.towards(direction), all), now);
  const { front, back } = about.camera;
  let untouched = true;
  const resize = () => {
    const box = canvas.parentElement.getBoundingClientRect();
    if (box.width < 2 || box.height < 2) return;
    scene.resize(box.width, box.height);
    camera.resize(box.width, box.height);
    if (untouched) fit(front, true);
    scene.draw(camera); // at once: a canvas is empty after a change of its size
  };
  new ResizeObserver(resize).observe(canvas.parentElement);
  find("home").onclick = () => fit(front);
  find("back").onclick = () => fit(back);
  find("whole").hidden = !document.fullscreenEnabled;
  find("whole").onclick = () => (document.fullscreenElement ? document.exitFullscreen() : view.requestFullscreen());
  for (const kind of ["pointerdown", "wheel", "keydown"]) {
    view.addEventListener(kind, () => (untouched = false), { passive: true });
    canvas.addEventListener(kind, () => (find("hint").hidden = true), { passive: true }); // it may hide something
  }

  // --- the axes, to look along
  const axes = find("axes");
  const letters = ["x", "y", "z"].flatMap((name, k) => [1, -1].map((sign) => {
    const button = made("button", (sign > 0 ? "plus " : "minus ") + name, sign > 0 ? name : "", axes);
    button.type = "button";
    button.title = (sign > 0 ? "+" : "\u2212") + name;
    button.onclick = () => fit([0, 1, 2].map((j) => (j === k ? -sign : 0)));
    const stem = sign > 0 ? made("i", name, undefined, axes) : null;
    return { button, stem, k, sign };
  }));
  function drawAxes() {
    const { out, right, upward } = camera.axes();
    for (const { button, stem, k, sign } of letters) {
      const [x, y] = [26 * sign * right[k], -26 * sign * upward[k]];
      button.style.transform = `translate(${x}px, ${y}px)`;
      button.style.zIndex = Math.round(10 + 9 * sign * out[k]);
      if (!stem) continue;
      stem.style.width = Math.hypot(x, y) + "px";
      stem.style.transform = `rotate(${Math.atan2(y, x)}rad)`;
    }
  }

  // --- colours
  const chosen = find("mode");
  about.modes.forEach((mode, k) => chosen.add(new Option(mode.label, k)));
  const mode = () => about.modes[chosen.value];
  const recolour = () => {
    scene.colour(mode());
    drawLegend(find("legend"), mode(), texts);
    redraw();
  };
  chosen.onchange = recolour;

  // --- the worst spots
  const glyphs = about.spots.map((spot, k) => {
    const glyph = made("button", "glyph", spot.number, find("marks"));
    glyph.type = "button";
    glyph.title = spot.text;
    glyph.onclick = () => visit(spot);
    const line = view.querySelector(`[data-spot="${k}"]`);
    line.onclick = () => visit(spot);
    const point = spot.point.map((value, j) => value - result.middle[j]);
    return { glyph, spot, point };
  });
  const free = (point, out) => {
    const away = 4 * reach;
    const met = scene.pick({ origin: along(point, out, away), direction: out.map((value) => -value) });
    return !met || met.distance > away - 4 * about.spacing;
  };
  function placeMarks() {
    const { out } = camera.axes();
    for (const { glyph, spot, point } of glyphs) {
      const seen = dot(spot.normal, out) > 0.03 && scene.shown(point) && free(along(point, spot.normal, about.spacing), out);
      const [x, y] = camera.pixel(point);
      glyph.hidden = !seen;
      glyph.style.transform = `translate(${x}px, ${y}px)`;
    }
  }
  // Looks at a spot along its normal, or as near to that as nothing hides it.
  function visit(spot) {
    const { point } = glyphs.find((one) => one.spot === spot);
    const side = unit(cross(spot.normal, Math.abs(spot.normal[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
    const other = cross(spot.normal, side);
    let out = spot.normal;
    search: for (const tilt of [0.35, 0, 0.7, 1.05, 1.3]) {
      for (let k = 0; k < 8; k++) {
        const round = (Math.PI * k) / 4 + 0.4;
        const level = along(side.map((value) => Math.cos(round) * value), other, Math.sin(round));
        const way = unit(along(spot.normal.map((value) => Math.cos(tilt) * value), level, Math.sin(tilt)));
        if (free(along(point, spot.normal, about.spacing), way)) {
          out = way;
          break search;
        }
      }
    }
    const height = Math.min(Math.max(2.5 * spot.extent, 0.2 * result.radius, 40 * about.spacing), result.radius);
    camera.go({ ...camera.towards(out.map((value) => -value)), target: point, height });
  }

  // --- readings
  const tip = find("tip");
  let asked = null;
  const read = (x, y) => {
    const met = scene.pick(camera.ray(x, y));
    tip.hidden = !met;
    if (!met) return;
    const lines = met.sample < 0 ? [texts.rest] : reading(result, mode(), met.sample, number);
    tip.replaceChildren();
    lines.forEach((line, k) => made(k ? "span" : "b", "", line, tip));
    tip.dataset.sample = met.sample;
    const room = canvas.getBoundingClientRect();
    tip.style.left = Math.min(x + 16, room.width - tip.offsetWidth - 8) + "px";
    tip.style.top = (y + 20 + tip.offsetHeight > room.height ? y - tip.offsetHeight - 12 : y + 20) + "px";
  };
  steer(canvas, camera, about.alone, {
    home: () => fit(front),
    centre: (x, y) => {
      const met = scene.pick(camera.ray(x, y));
      if (met) camera.go({ target: met.point });
    },
    point: (x, y) => {
      if (asked) cancelAnimationFrame(asked);
      asked = requestAnimationFrame(() => read(x, y));
    },
    leave: () => {
      if (asked) cancelAnimationFrame(asked);
      tip.hidden = true;
    },
    press: (x, y) => read(x, y),
  });

  // --- section
  const [low, high] = [0, 1].map((k) => about.box[k].map((value, j) => value - result.middle[j]));
  let normal = null;
  let side = 1;
  const span = () => {
    let [least, most] = [Infinity, -Infinity];
    for (let corner = 0; corner < 8; corner++) {
      const at = dot(normal, [0, 1, 2].map((k) => (corner & (1 << k) ? high[k] : low[k])));
      [least, most] = [Math.min(least, at), Math.max(most, at)];
    }
    return [least, most];
  };
  const cut = () => {
    find("cutting").hidden = !normal;
    find("flip").hidden = !normal;
    if (normal) {
      const [least, most] = span();
      const place = least + ((most - least) * find("place").value) / 1000;
      const times = Number(find("times").value);
      scene.section({ normal, place, side }, times);
      find("where").value = number(place + dot(normal, result.middle), 1) + " mm";
      const keys = find("lines");
      keys.replaceChildren();
      made("span", "design", texts.design, keys);
      made("span", "ground", texts.ground.replace("{times}", times), keys);
    } else {
      scene.section(null);
    }
    redraw();
  };
  find("cut").onchange = () => {
    const { out } = camera.axes();
    const name = find("cut").value;
    normal = !name ? null : name === "view" ? out : [0, 1, 2].map((k) => ("xyz"[k] === name ? 1 : 0));
    side = normal && dot(normal, out) < 0 ? -1 : 1;
    cut();
  };
  find("flip").onclick = () => {
    side = -side;
    cut();
  };
  find("place").oninput = cut;
  find("times").onchange = cut;

  // --- the wheel on its way
  if (about.wheel) {
    const way = inBox(result.arrays["wheel.place"], about.wheel.box, result.middle);
    const { time: whole } = about.wheel;
    const slider = find("time");
    const [play, moment] = [find("play"), find("moment")];
    let running = 0;
    const show = () => {
      const time = (whole * slider.value) / 1000;
      const frame = wheelAt(result, way, time);
      scene.placeWheel(frame);
      scene.setNow(about.traced ? frame.motion : null);
      const told = texts.seconds.replace("{time}", number(time, 1)).replace("{whole}", number(whole, 1));
      moment.textContent = `${told}; ${motionName(result, frame.motion)}`;
      find("final").hidden = false;
      redraw();
    };
    const stop = () => {
      cancelAnimationFrame(running);
      running = 0;
      play.textContent = texts.play;
      if (Number(slider.value) >= 1000) end();
    };
    const end = () => {
      scene.placeWheel(null);
      scene.setNow(null);
      moment.textContent = "";
      find("final").hidden = true;
      redraw();
    };
    play.onclick = () => {
      if (running) {
        stop();
        return;
      }
      if (Number(slider.value) >= 1000) slider.value = 0;
      play.textContent = texts.pause;
      let [share, before] = [slider.value / 1000, performance.now()];
      const pace = 1000 * Math.max(FASTEST, Math.min(whole, SLOWEST));
      const step = (now) => {
        share = Math.min(share + (now - before) / pace, 1);
        before = now;
        slider.value = 1000 * share;
        show();
        if (share < 1) running = requestAnimationFrame(step);
        else stop();
      };
      running = requestAnimationFrame(step);
    };
    slider.oninput = () => {
      if (running) stop();
      show();
    };
    slider.step = "any";
  }

  canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", redraw);
  recolour();
  resize();
  document.documentElement.classList.add("turning"); // the pictures in its place may go
  view.dataset.ready = "yes";
  // For tests and for the curious: the field at hand.
  window.beltgrindingView = { result, camera, scene, reading: (i) => reading(result, mode(), i, number) };
}

start().catch((error) => {
  const view = document.getElementById("view");
  const about = JSON.parse(document.getElementById("view-about").textContent);
  view.hidden = false;
  view.classList.add("failed");
  view.textContent = about.texts.slow.replace("{reason}", () => error.message);
  document.documentElement.classList.remove("turning");
});
