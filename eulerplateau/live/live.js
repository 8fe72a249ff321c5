// The page of a live film: sliders ask the server, films and points come back.

const find = (id) => document.getElementById(id);
// Milliseconds from a slider's move to the film drawn for it: of the last ones.
const latencies = [];
const KEPT = 1000;
const ROUNDING = 1e-9; // nothing that is shown is so small

let about = null; // what the server said first
let quantities = [];
let diagram = null;
let film = null;
let mesh = null; // { loop }: what never changes
let tiles = null;
let normal = null; // of the plane next to the film
let asked = 0; // numbers what is asked
let answered = 0, wished = 0; // the last wish that was answered, and the last there was
const askedAt = new Map(); // when a slider asked
const lastAsked = new Map(); // the number of what each slider asked for last, by its key
let held = null; // the key of the slider that is held
let typing = null; // the key of the number that is typed
let socket = null;
const cells = new Map(); // of the numbers, by their keys
let last = null; // the row that is to be shown
let pausing = null; // until numbers are shown again
const PAUSE = 100; // milliseconds
let inSoftware = false; // no graphics card draws
let settling = null; // until the film is drawn finely
// So long after the last film; and pixels each way while films come, of those there are.
const SETTLING = 300, COARSE = 0.5;
let seeking = null; // until it is said that a film takes long
let saidUntil = 0; // the time up to which what was said stays
// Milliseconds of what takes long, and of what one has to read.
const LONG = 500, READ = 4000;

function connect() {
  socket = new WebSocket(new URL("talk", location.href.replace(/^http/, "ws")));
  socket.addEventListener("message", ({ data }) => {
    const told = JSON.parse(data);
    if (told.varied) open(told);
    else show(told);
  });
  socket.addEventListener("close", () => {
    clearTimeout(seeking);
    say("The film is no longer served: eulerplateau live has ended.", { failed: true });
    document.body.dataset.state = "closed";
    for (const control of document.querySelectorAll("#varied input, nav button")) {
      control.disabled = true;
    }
  });
}

function send(what) {
  if (socket.readyState !== WebSocket.OPEN) return;
  asked += 1;
  socket.send(JSON.stringify({ ...what, asked }));
}

// What a slider, a number or a button asks for.
function wish(what) {
  send(what);
  wished = asked;
  if (!seeking) seekingSoon();
}

function seekingSoon() {
  seeking = setTimeout(() => say("Seeking the film ...", { reading: 0 }), LONG);
}

// The first that is told: what can be varied, and how shapes are decoded.
function open(told) {
  about = told;
  document.title = `${about.name} live`;
  mesh = { loop: decode(about.loop, Uint32Array) };
  about.varied = about.varied.map((each) => {
    const known = QUANTITIES.film.find(({ key }) => key === each.key);
    return { ...each, label: known.label, symbol: known.symbol };
  });
  find("varied").replaceChildren(...about.varied.map(slider));
  diagram = new VisitedDiagram(find("chart"), about.varied);
  try {
    inSoftware = drawsInSoftware();
    film = new Film(find("film"), { ...about, radius: 0, antialias: !inSoftware }, makeScale);
  } catch {
    find("scale").hidden = true;
    find("no-webgl").hidden = false;
  }
  makeLegend();
}

function makeScale() {
  if (film && normal) film.tellScale(find, "L", normal);
}

// Whether there is no graphics card: smooth edges and many pixels then take most of the time.
function drawsInSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const names = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = names ? gl.getParameter(names.UNMASKED_RENDERER_WEBGL) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe/i.test(name);
}

// A slider and a number to type, for one quantity.
function slider({ key, symbol, unit, low, high }) {
  const line = document.createElement("label");
  const range = Object.assign(document.createElement("input"), {
    type: "range", min: low, max: high, step: "any", id: `range-${key}`,
  });
  const number = Object.assign(document.createElement("input"), {
    type: "number", min: low, max: high, step: "any", id: `number-${key}`,
  });
  range.setAttribute("aria-label", symbol);
  number.setAttribute("aria-label", `${symbol}, to type`);
  const follow = (value) => {
    askedAt.set(asked + 1, performance.now());
    lastAsked.set(key, asked + 1);
    wish({ follow: { [key]: value } });
  };
  range.addEventListener("input", () => {
    number.value = short(range.valueAsNumber);
    follow(range.valueAsNumber);
  });
  range.addEventListener("pointerdown", () => { held = key; });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
    range.addEventListener(end, () => { held = null; });
  }
  number.addEventListener("input", () => { typing = key; });
  number.addEventListener("change", () => {
    typing = null;
    if (Number.isFinite(number.valueAsNumber)) follow(number.valueAsNumber);
  });
  line.append(unit ? `${symbol} (${unit})` : symbol, range, number);
  return line;
}

// What has happened since: points, the shape as it is now, what there is to say.
function show(told) {
  answered = told.answered;
  clearTimeout(seeking);
  seeking = null;
  if (answered < wished) seekingSoon();
  if (told.points) showPoints(told);
  for (const line of told.said ?? []) say(line);
  // Drawn when the browser draws; the server then sends what there is by then.
  requestAnimationFrame(() => {
    if (told.points) drawFilm(told);
    send({ drawn: true });
  });
}

function showPoints({ points }) {
  const point = points.at(-1);
  if (!quantities.length) chooseQuantities(point.row);
  diagram.add(points);
  for (const { key, symbol, unit } of about.varied) {
    const value = point.values[key];
    // Who has asked for another value sees that one until it is answered.
    const ahead = held === key || (lastAsked.get(key) ?? 0) > answered;
    if (!ahead) {
      find(`range-${key}`).value = value;
      if (typing !== key) find(`number-${key}`).value = short(value);
    }
    if (key === about.varied[0].key) {
      const written = [shownText(value), unit].filter(Boolean).join(" ");
      find("headline").textContent = `${about.name}: ${symbol} = ${written}`;
    }
  }
  showNumbers({ ...point.row, ...point.values });
  if (point.advice) say(`${point.row.status}: ${point.advice}`, { failed: true, reading: 0 });
  else if (point.jumped) say("The film jumped, and lost energy, on the way here.");
  else if (performance.now() > saidUntil) say("");
  // For tests, and for whoever drives the page from outside.
  Object.assign(document.body.dataset, { number: point.number, state: point.row.status });
}

// The numbers, so many times a second that one can read them at all.
function showNumbers(row) {
  last = row;
  if (pausing) return;
  for (const { key, unit } of quantities) {
    cells.get(key).textContent = shownText(row[key]) + (row[key] !== null && unit ? ` ${unit}` : "");
  }
  pausing = setTimeout(() => {
    pausing = null;
    if (last !== row) showNumbers(last);
  }, PAUSE);
}

function drawFilm(told) {
  if (told.triangles) tiles = decode(told.triangles, Uint32Array);
  const { x, marks, radius } = told.shape;
  normal = told.shape.normal;
  const positions = Float32Array.from(decode(x, Int16Array), (value) => value * about.unit);
  if (inSoftware) drawCoarsely();
  film?.show(mesh, tiles, positions, marks && decode(marks, Int8Array), radius);
  document.body.dataset.drawn = told.points.at(-1).number;
  if (!askedAt.has(answered)) return;
  latencies.push(performance.now() - askedAt.get(answered));
  if (latencies.length > KEPT) latencies.shift();
  for (const before of askedAt.keys()) if (before <= answered) askedAt.delete(before);
}

// While one film comes after another; the last is drawn finely when no more come.
function drawCoarsely() {
  if (settling) film?.setDetail(COARSE);
  clearTimeout(settling);
  settling = setTimeout(() => {
    settling = null;
    film?.setDetail(1);
    film?.draw();
  }, SETTLING);
}

function chooseQuantities(row) {
  const units = new Map(about.varied.map(({ key, unit }) => [key, unit]));
  quantities = QUANTITIES.film.filter(({ key }) => key in row)
    .map((quantity) => ({ ...quantity, unit: units.get(quantity.key) || quantity.unit }));
  for (const { label, key } of about.varied) find("x").add(new Option(label, key));
  for (const { label, key, axis } of quantities) {
    if (axis === "y") find("y").add(new Option(label, key));
  }
  find("row").replaceChildren(...quantities.map(({ key, label }) => {
    const [pair, name, cell] = ["div", "dt", "dd"].map((tag) => document.createElement(tag));
    name.textContent = label;
    cells.set(key, cell);
    pair.append(name, cell);
    return pair;
  }));
  setAxes();
}

function setAxes() {
  const x = about.varied.find(({ key }) => key === find("x").value);
  diagram.setAxes(x, quantities.find(({ key }) => key === find("y").value));
}

function makeLegend() {
  const entries = Object.values(VisitedDiagram.KINDS).map(({ colour, glyph, label }) => {
    const [entry, mark] = [document.createElement("span"), document.createElement("b")];
    mark.style.color = colour;
    mark.textContent = glyph;
    entry.append(mark, label);
    return entry;
  });
  const words = document.createElement("span");
  words.textContent = "open: unstable or not known; dashed: a jump";
  find("legend").replaceChildren(...entries, words);
}

function say(text, { failed = false, reading = READ } = {}) {
  find("said").textContent = text;
  find("said").classList.toggle("failed", failed);
  saidUntil = performance.now() + (text ? reading : 0);
}

function short(value) {
  return Number(value.toPrecision(6));
}

// A cell as it is written, rounding as 0.
function shownText(value) {
  return typeof value === "number" && Math.abs(value) < ROUNDING ? "0" : text(value, 6);
}

for (const what of ["kick", "other", "begin", "save"]) {
  find(what).addEventListener("click", () => {
    if (what === "other") say("Seeking another stable state ...", { reading: 0 });
    wish({ click: what });
  });
}
for (const axis of ["x", "y"]) find(axis).addEventListener("change", setAxes);
find("show-all").addEventListener("click", () => diagram.whole());
find("view").addEventListener("click", () => film?.firstView());
find("above").addEventListener("click", () => film?.above(normal));
connect();
