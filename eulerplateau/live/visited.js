// The diagram of a live film: the points visited, as they come, and the jumps between them.

class VisitedDiagram {
  // Okabe and Ito's colours, which the colour-blind can tell apart.
  static KINDS = {
    rising: { colour: "#0072B2", style: "triangle", glyph: "▲", label: "rising" },
    falling: { colour: "#D55E00", style: "rectRot", glyph: "◆", label: "falling" },
    put: { colour: "#009E73", style: "circle", glyph: "●", label: "put there" },
    failed: { colour: "#D00000", style: "crossRot", glyph: "×", label: "not converged" },
  };

  // As many as the server remembers.
  static REMEMBERED = 3000;

  // Milliseconds between two drawings, and how often as long as one took: the film is more
  // urgent.
  static PAUSE = 250;
  static REST = 8;

  constructor(canvas, varied) {
    this.points = [];
    this.varied = varied;
    this.next = 0; // when it may be drawn again
    this.fits = true; // until somebody zooms or moves it
    const free = () => { this.fits = false; };
    const kinds = Object.entries(VisitedDiagram.KINDS);
    this.sets = Object.fromEntries(kinds.map(([name, { colour, style }]) => [name, {
      data: [], pointStyle: style, pointBorderColor: colour, pointBackgroundColor: [],
      pointRadius: style === "crossRot" ? 5 : 3, order: 3,
    }]));
    this.jumps = {
      data: [], showLine: true, borderColor: "#000000", borderWidth: 1.2, borderDash: [5, 4],
      pointRadius: 0, order: 2, spanGaps: false,
    };
    this.ring = {
      data: [], clip: 12, pointRadius: 10, pointBorderWidth: 3, order: 1,
      pointBorderColor: "#D00000", pointBackgroundColor: "transparent",
    };
    this.chart = new Libraries.Chart(canvas, {
      type: "scatter",
      data: { datasets: [...Object.values(this.sets), this.jumps, this.ring] },
      options: {
        animation: false,
        maintainAspectRatio: false,
        events: [],
        scales: { x: Diagram.axis(), y: Diagram.axis() },
        plugins: {
          zoom: {
            pan: { enabled: true, threshold: 8, onPan: free },
            zoom: {
              wheel: { enabled: true }, pinch: { enabled: true }, mode: "xy", onZoom: free,
            },
          },
        },
      },
    });
  }

  // Draw `y` over `x`: of what is varied, and of the quantities.
  setAxes(x, y) {
    this.axes = { x, y };
    for (const [name, { label, unit }] of Object.entries(this.axes)) {
      this.chart.options.scales[name].title.text = unit ? `${label} (${unit})` : label;
    }
    this.clear();
    this.points.forEach((point, place) => this.place(point, this.points[place - 1]));
    this.whole();
  }

  clear() {
    for (const set of [...Object.values(this.sets), this.jumps, this.ring]) set.data = [];
    for (const set of Object.values(this.sets)) set.pointBackgroundColor = [];
  }

  add(points) {
    for (const point of points) {
      this.place(point, this.points.at(-1));
      this.points.push(point);
    }
    if (this.points.length > VisitedDiagram.REMEMBERED) {
      this.points = this.points.slice(-VisitedDiagram.REMEMBERED / 2);
      this.setAxes(this.axes.x, this.axes.y);
    }
    this.drawSoon();
  }

  place(point, before) {
    const kind = this.kind(point, before);
    const at = this.at(point);
    this.sets[kind].data.push(at);
    this.sets[kind].pointBackgroundColor.push(
      point.row.n_unstable === 0 ? VisitedDiagram.KINDS[kind].colour : "#ffffff");
    if (point.jumped && before) this.jumps.data.push(this.at(before), at, { x: NaN, y: NaN });
    this.ring.data = [at];
  }

  kind(point, before) {
    if (point.row.status !== "converged") return "failed";
    if (point.way !== "follow" || !before) return "put";
    const moved = this.varied.map(({ key }) => point.values[key] - before.values[key]);
    return (moved.find((by) => by !== 0) ?? 0) < 0 ? "falling" : "rising";
  }

  at({ values, row }) {
    return { x: values[this.axes.x.key], y: row[this.axes.y.key] ?? NaN };
  }

  drawSoon() {
    if (this.waiting) return;
    this.waiting = setTimeout(() => {
      const begun = performance.now();
      this.waiting = null;
      if (this.fits) this.whole();
      else this.chart.update("none");
      const now = performance.now();
      const took = now - begun;
      this.next = now + Math.max(VisitedDiagram.PAUSE, VisitedDiagram.REST * took);
    }, Math.max(this.next - performance.now(), 0));
  }

  // Show all of it, with a margin.
  whole() {
    this.fits = true;
    const { low, high } = this.varied.find(({ key }) => key === this.axes.x.key);
    const values = this.points.map((point) => this.at(point).y).filter(Number.isFinite);
    const ends = { x: [low, high], y: values.length
      ? [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))]
      : [0, 1] };
    for (const [name, [least, most]] of Object.entries(ends)) {
      // Rounding is not to look like a change.
      const size = Math.max(Math.abs(least), Math.abs(most));
      const margin = size < 1e-6 ? 0.1 : Math.max(0.04 * (most - least), 1e-3 * size);
      Object.assign(this.chart.options.scales[name], { min: least - margin, max: most + margin });
    }
    this.chart.update("none");
  }
}
