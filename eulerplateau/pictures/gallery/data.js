// The runs as the page holds them, their shapes and meshes decoded.

function decode(text, Type) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Type(bytes.buffer);
}

// A cell as it is written, a number with so many digits.
function text(value, digits) {
  if (value === null) return "–";
  if (typeof value !== "number") return value;
  const small = Math.abs(value) < 1e-3 || Math.abs(value) >= 1e6;
  const written = Number.isInteger(value) ? String(value)
    : small ? value.toExponential(digits - 1) : value.toPrecision(digits);
  return written.replaceAll("-", "−");
}

function readGallery(element) {
  const gallery = JSON.parse(element.textContent);
  element.remove();
  const meshes = gallery.meshes.map((mesh) => ({
    vertices: mesh.vertices,
    triangles: decode(mesh.triangles, Uint32Array),
    loop: decode(mesh.loop, Uint32Array),
  }));
  const runs = gallery.runs.map((run) => ({
    ...run,
    mesh: meshes[run.mesh],
    tilings: run.tilings.map(([first, text]) => [first, decode(text, Uint32Array)]),
    shapes: decode(run.shapes, Int16Array),
    marks: run.marks && decode(run.marks, Int8Array),
    rows: run.rows.map((cells) =>
      Object.fromEntries(cells.map((cell, column) => [gallery.columns[column], cell]))),
  }));
  return { ...gallery, meshes, runs };
}

// Positions of one shape, (3 n_v) numbers in units of L, of cells R_0.
function positions(gallery, run, place) {
  const size = 3 * run.mesh.vertices;
  const whole = run.shapes.subarray(place * size, (place + 1) * size);
  return Float32Array.from(whole, (value) => value * gallery.unit);
}

// Directions across the loop's edges of one shape in which its wire is marked, (3 n_b)
// numbers up to 127; null in a run without marks.
function marks(run, place) {
  const size = 3 * run.mesh.loop.length;
  return run.marks && run.marks.subarray(place * size, (place + 1) * size);
}

// Triangles of one shape: the mesh's, but where a film's mesh was repaired.
function triangles(run, place) {
  const changed = run.tilings.filter(([first]) => first <= place);
  return changed.length ? changed.at(-1)[1] : run.mesh.triangles;
}

// Every curve of the diagram: a branch or a leg of a sweep, with the points it is drawn
// through. The first may belong to the curve it branches off from.
function curves(gallery) {
  const found = [];
  for (const [number, run] of gallery.runs.entries()) {
    for (const series of run.series) {
      const places = [];
      for (let place = series.first; place <= series.last; place++) places.push(place);
      const drawn = series.origin === null ? places : [series.origin, ...places];
      found.push({ ...series, number, run, places, drawn });
    }
  }
  return found;
}

// Whether a curve is stable (true, false, or null if not known) from one row to the next.
// At a special point the critical eigenvalue has no sign: the other end tells.
function isStable(before, after) {
  const regular = [before, after].filter((row) => row.special === null);
  const ends = regular.length ? regular : [before, after];
  if (ends.some((row) => row.n_unstable === null)) return null;
  return ends.every((row) => row.n_unstable === 0);
}
