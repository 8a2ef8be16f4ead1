// What a point is called, and the way of the wheel.

// Lines of text on the sample ``i``: its deviation first, then what the colours show, where, and by what.
function reading(result, mode, i, number) {
  const { about, arrays } = result;
  const { texts, modes } = about;
  const told = (one) => number(result.value(one, i), one.decimals, one.sign) + (one.unit ? " " + one.unit : "");
  const lines = [];
  const deviation = result.value(modes[0], i);
  const [zone, lower, upper] = about.zones[arrays.zones[i]];
  if (Number.isNaN(deviation)) {
    lines.push(texts.missed);
  } else {
    const verdict = deviation > upper ? texts.above : deviation < lower ? texts.below : texts.in;
    lines.push(`${told(modes[0])}: ${verdict}`);
  }
  if (!["deviation", "verdict", "motion", "face"].includes(mode.key)) {
    const value = result.value(mode, i);
    lines.push(`${mode.label}: ${Number.isNaN(value) ? mode.missing : told(mode)}`);
  }
  let where = "Face" + about.faces[arrays.faces[i]];
  if (zone) where += ", " + texts.zone.replace("{name}", () => zone);
  const limits = { lower: number(lower, 3, true), upper: number(upper, 3, true) };
  lines.push(where + "; " + texts.limits.replace(/\{(\w+)\}/g, (_, key) => limits[key]));
  if (about.traced) {
    const motion = arrays["motion.dominant"][i];
    lines.push(motion ? texts.made.replace("{motion}", () => motionName(result, motion)) : texts.untouched);
  }
  const place = [0, 1, 2].map((k) => number(result.design[3 * i + k] + result.middle[k], 2));
  lines.push(`(${place.join(about.language === "de" ? "; " : ", ")}) mm`);
  return lines;
}

// A motion, counted from 1 through all programs, by the line of its program if that is known.
function motionName(result, motion) {
  const { about, arrays } = result;
  const lines = arrays["motion.line"];
  const line = lines && motion <= lines.length ? lines[motion - 1] : 0;
  const text = line
    ? about.texts.line.replace("{line}", line)
    : about.texts.motion.replace("{number}", motion);
  const program = lines && motion <= lines.length ? about.programs[arrays["motion.program"][motion - 1]] : null;
  return program && about.programs.length > 1 ? `${program}, ${text}` : text;
}

// The wheel's frame and motion at a time, s: between two moments along the straight line and the least turn.
function wheelAt(result, way, time) {
  const times = result.arrays["wheel.time"];
  let [low, high] = [0, times.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= 1000 * time) low = middle;
    else high = middle;
  }
  const span = times[high] - times[low];
  const t = span > 0 ? Math.max(0, Math.min(1, (1000 * time - times[low]) / span)) : 0;
  const turns = result.arrays["wheel.turn"];
  const turn = (k) => [0, 1, 2, 3].map((c) => (2 * turns[4 * k + c]) / STEPS - 1);
  const [a, b] = [turn(low), turn(high)];
  const sign = a.reduce((sum, value, k) => sum + value * b[k], 0) < 0 ? -1 : 1;
  const mixed = a.map((value, k) => value + t * (sign * b[k] - value));
  const length = Math.hypot(...mixed) || 1;
  const place = [0, 1, 2].map((k) => way[3 * low + k] + t * (way[3 * high + k] - way[3 * low + k]));
  return {
    place,
    turn: mixed.map((value) => value / length),
    motion: result.arrays["wheel.motion"][high],
  };
}
