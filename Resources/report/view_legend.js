// The colours' legend, and numbers as the page's language writes them.

// The class puts the texts; ``language``: "en" or "de".
function numberIn(language) {
  return (value, decimals, sign = false) => {
    const rounded = Number(value.toFixed(decimals)) + 0;
    let text = Math.abs(rounded).toFixed(decimals);
    if (language === "de") text = text.replace(".", ",");
    if (rounded < 0) return "\u2212" + text;
    return sign ? "+" + text : text;
  };
}

function made(tag, name, text, parent) {
  const found = document.createElement(tag);
  if (name) found.className = name;
  if (text !== undefined) found.textContent = text;
  if (parent) parent.append(found);
  return found;
}

const BAR = 156; // pixels
const LABEL = 15; // pixels that a line needs

// Draws a mode's legend into ``place``.
function drawLegend(place, mode, texts) {
  place.replaceChildren();
  const gone = mode.key === "face" ? null : [MISSED.toString(16), mode.missing];
  if (mode.swatches) {
    const list = made("ul", "swatches", undefined, place);
    for (const [colour, text] of gone ? [...mode.swatches, gone] : mode.swatches) {
      const line = made("li", "", undefined, list);
      if (colour) made("i", "", undefined, line).style.background = "#" + colour;
      line.append(text);
    }
    return;
  }
  const { low, high, colours } = mode.scale;
  made("p", "unit", mode.unit, place);
  const frame = made("div", "bar", undefined, place);
  frame.style.height = BAR + "px";
  const canvas = made("canvas", "", undefined, frame);
  canvas.width = 1;
  canvas.height = colours.length;
  const context = canvas.getContext("2d");
  colours.forEach((colour, k) => {
    context.fillStyle = "#" + colour;
    context.fillRect(0, colours.length - 1 - k, 1, 1);
  });
  const at = (value) => BAR * (1 - (value - low) / (high - low));
  for (const [value, text, shift] of apart(mode.ticks, at)) {
    const tick = made("span", "tick", text, frame);
    tick.style.top = at(value) + shift + "px";
    made("span", "notch", undefined, frame).style.top = at(value) + "px";
  }
  for (const [value, text] of mode.words) {
    made("span", "word", text, frame).style.top = at(value) + "px";
  }
  const list = made("ul", "swatches", undefined, place);
  const line = made("li", "", undefined, list);
  made("i", "", undefined, line).style.background = "#" + gone[0];
  line.append(gone[1]);
}

// Ticks [value, text, shift]: those that would run into each other are moved apart by some pixels.
function apart(ticks, at) {
  const sorted = [...ticks].sort((a, b) => at(a[0]) - at(b[0])).map(([value, text]) => [value, text, 0]);
  for (let k = 1; k < sorted.length; k++) {
    const gap = at(sorted[k][0]) + sorted[k][2] - at(sorted[k - 1][0]) - sorted[k - 1][2];
    if (gap >= LABEL) continue;
    sorted[k - 1][2] -= 0.5 * (LABEL - gap);
    sorted[k][2] += 0.5 * (LABEL - gap);
  }
  return sorted;
}
