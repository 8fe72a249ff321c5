// The page: one point of one curve is shown; clicks, keys, slider and buttons change which.

const gallery = readGallery(document.getElementById("data"));
const all = curves(gallery);
const find = (id) => document.getElementById(id);
const several = gallery.runs.length > 1;
// Of a loop that resists twist, or has a thickness, there are more.
const quantities = QUANTITIES[gallery.kind]
  .filter(({ key }) => gallery.columns.includes(key))
  .map((quantity) => quantity.key === gallery.load && gallery.loadUnit
    ? { ...quantity, unit: gallery.loadUnit } : quantity);
const load = quantities.find(({ key }) => key === gallery.load);
let shown = null; // { curve, place }: place is the row's number in its run
let film = null;

function show(curve, place) {
  shown = { curve, place };
  const row = curve.run.rows[place];
  // For tests, and for whoever drives the page from outside.
  Object.assign(document.body.dataset, {
    run: curve.run.name, series: curve.name, step: row.step,
  });
  makeScale();
  film?.show(
    curve.run.mesh, triangles(curve.run, place), positions(gallery, curve.run, place),
    marks(curve.run, place), curve.run.radii[place]);
  diagram.mark(row);
  const value = [text(row[load.key], 7), load.unit].filter(Boolean).join(" ");
  find("headline").textContent = `${curve.name}: ${load.symbol} = ${value}`;
  find("place").max = curve.places.length - 1;
  find("place").value = place - curve.first;
  find("row").replaceChildren(
    line("run", curve.run.name),
    ...quantities.map(({ key, label, unit }) => line(label, row[key], unit)),
  );
  find("special").textContent = aboutSpecial(curve.run.special[row.special]);
}

function makeScale() {
  if (film && shown) film.tellScale(find, gallery.length, normal());
}

function normal() {
  return shown.curve.run.normals[shown.place];
}

function line(label, value, unit) {
  const [pair, name, number] = ["div", "dt", "dd"].map((tag) => document.createElement(tag));
  name.textContent = label;
  number.textContent = text(value, 6) + (value !== null && unit ? ` ${unit}` : "");
  pair.append(name, number);
  return pair;
}

function aboutSpecial(special) {
  if (!special) return "";
  const { kind, number, breaks, keeps, contact } = special;
  if (contact) return `Point ${number}: contact ${contact}.`;
  return `Point ${number}, a ${kind}. Its mode breaks: ${breaks || "no symmetry"}. `
    + `It keeps: ${keeps || "none"}.`;
}

// Of several points at the place clicked, the next after the one shown.
function pick(hits) {
  const at = hits.findIndex(({ curve, place }) =>
    curve === shown.curve && place === shown.place);
  const next = hits[(at + 1) % hits.length];
  show(next.curve, next.place);
}

function along(count) {
  const { curve, place } = shown;
  show(curve, Math.min(Math.max(place + count, curve.first), curve.last));
}

// To the curve before or after, there to the point nearest to the one shown.
function across(count) {
  const visible = all.filter((curve) => !curve.hidden || curve === shown.curve);
  const at = visible.indexOf(shown.curve) + count;
  const curve = visible[(at + visible.length) % visible.length];
  const row = shown.curve.run.rows[shown.place];
  const away = curve.places.map((place) => diagram.distance(row, curve.run.rows[place]));
  show(curve, curve.places[Math.max(away.indexOf(Math.min(...away)), 0)]);
}

function makeLegend() {
  for (const alike of diagram.groups.values()) {
    const [first] = alike;
    const label = document.createElement("label");
    const box = document.createElement("input");
    box.type = "checkbox";
    box.checked = true;
    box.addEventListener("change", () =>
      alike.forEach((curve) => diagram.setVisible(curve, box.checked)));
    const dash = document.createElement("i");
    dash.style.color = first.colour;
    dash.textContent = Diagram.MARKERS[first.marker].sign;
    label.append(box, dash, several ? first.run.name : groupName(alike));
    find("legend").append(label);
  }
}

function groupName(alike) {
  const [{ name, group }] = alike;
  if (name === group) return name;
  return `${alike.map((curve) => curve.name.replace("branch ", "")).join(", ")} ${group}`;
}

function makeChoice(axis) {
  const choice = find(axis);
  for (const { key, label, axis: offered } of quantities) {
    if (offered === axis) choice.add(new Option(label, key));
  }
  choice.addEventListener("change", () => {
    setAxes();
    choice.blur(); // so that the arrow keys move along the branch again
  });
}

function setAxes() {
  const [x, y] = ["x", "y"].map((axis) =>
    quantities.find(({ key }) => key === find(axis).value));
  diagram.setAxes(x, y);
  if (shown) diagram.mark(shown.curve.run.rows[shown.place]);
}

const keys = {
  ArrowLeft: () => along(-1),
  ArrowRight: () => along(1),
  ArrowUp: () => across(-1),
  ArrowDown: () => across(1),
  Home: () => along(-Infinity),
  End: () => along(Infinity),
};
document.addEventListener("keydown", (event) => {
  const modified = event.ctrlKey || event.altKey || event.metaKey || event.shiftKey;
  if (modified || !keys[event.key] || event.target.tagName === "SELECT") return;
  event.preventDefault();
  keys[event.key]();
});
find("back").addEventListener("click", () => along(-1));
find("on").addEventListener("click", () => along(1));
find("up").addEventListener("click", () => across(-1));
find("down").addEventListener("click", () => across(1));
find("place").addEventListener("input", (event) =>
  show(shown.curve, shown.curve.first + Number(event.target.value)));
find("show-all").addEventListener("click", () => diagram.whole());
find("view").addEventListener("click", () => film?.firstView());
find("above").addEventListener("click", () => film?.above(normal()));

const diagram = new Diagram(find("chart"), all, pick);
try {
  film = new Film(find("film"), gallery, makeScale);
} catch {
  find("scale").hidden = true;
  find("no-webgl").hidden = false;
}
makeLegend();
makeChoice("x");
find("x").value = load.key;
makeChoice("y");
setAxes();
show(all[0], all[0].first);
