// The bifurcation diagram: a curve per branch, a ring around the point shown.

class Diagram {
  // Okabe and Ito's colours, which the colour-blind can tell apart; black comes first.
  static COLOURS = [
    "#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9",
  ];

  // What tells curves apart in grey, and how large it is to look as large as the others.
  static MARKERS = [
    { style: "circle", radius: 2.5, sign: "●" }, { style: "rect", radius: 3, sign: "■" },
    { style: "triangle", radius: 3.5, sign: "▲" }, { style: "rectRot", radius: 3.5, sign: "◆" },
  ];

  // Points closer than this on the screen (pixels) are taken for one place.
  static TOGETHER = 1;

  constructor(canvas, curves, onPick) {
    this.curves = curves;
    this.onPick = onPick;
    // Drawn alike: the curves of a run, or of one run those that start together.
    this.groups = new Map();
    const several = curves.some(({ number }) => number > 0);
    for (const curve of curves) {
      const key = several ? curve.number : curve.group;
      if (!this.groups.has(key)) this.groups.set(key, []);
      this.groups.get(key).push(curve);
    }
    [...this.groups.values()].forEach((alike, place) => {
      // As 7 and 4 have no factor in common, 28 groups have looks of their own.
      const colour = Diagram.COLOURS[place % Diagram.COLOURS.length];
      const marker = place % Diagram.MARKERS.length;
      for (const curve of alike) Object.assign(curve, { colour, marker });
    });
    this.ring = {
      data: [], order: -curves.length - 2, clip: 12, pointRadius: 10, pointBorderWidth: 3, pointHitRadius: 0,
      pointBorderColor: "#D00000", pointBackgroundColor: "transparent",
    };
    this.special = {
      data: [], order: -curves.length - 1, clip: 8, pointRadius: 6.5, pointBorderWidth: 1.5,
      pointBorderColor: "#000000", pointBackgroundColor: "#ffffff", pointStyle: [],
    };
    this.chart = new Libraries.Chart(canvas, {
      type: "scatter",
      data: { datasets: [...curves.map((...curve) => Diagram.dataset(...curve)), this.special, this.ring] },
      options: {
        animation: false,
        maintainAspectRatio: false,
        events: ["click"],
        onClick: (event) => this.pick(event),
        scales: { x: Diagram.axis(), y: Diagram.axis() },
        plugins: {
          zoom: {
            pan: { enabled: true, threshold: 8 },
            zoom: { wheel: { enabled: true }, pinch: { enabled: true }, mode: "xy" },
          },
        },
      },
    });
  }

  static axis() {
    return {
      title: { display: true, font: { size: 14 } },
      ticks: { maxRotation: 0, includeBounds: false, format: { useGrouping: false } },
    };
  }

  static dataset(curve, place) {
    const rows = curve.drawn.map((place) => curve.run.rows[place]);
    const { style, radius } = Diagram.MARKERS[curve.marker];
    const borrowed = (point) => curve.origin !== null && point === 0;
    return {
      showLine: true,
      order: -place, // later branches above: where the first is unstable, they may not be
      borderColor: curve.colour,
      borderWidth: 2,
      segment: {
        borderDash: (line) => {
          const stable = isStable(rows[line.p0DataIndex], rows[line.p1DataIndex]);
          return stable ? undefined : stable === null ? [2, 3] : [7, 5];
        },
        borderWidth: (line) =>
          isStable(rows[line.p0DataIndex], rows[line.p1DataIndex]) ? 2 : 1.2,
      },
      pointBorderColor: curve.colour,
      pointBackgroundColor: rows.map((row) =>
        row.n_unstable === 0 ? curve.colour : "#ffffff"),
      pointStyle: rows.map((row) => (row.status === "converged" ? style : "crossRot")),
      pointRadius: rows.map((row, point) =>
        borrowed(point) || row.special !== null ? 0 : row.status === "converged" ? radius : 5),
    };
  }

  // Draw `y` over `x`, two of the page's quantities; everything in sight.
  setAxes(x, y) {
    this.axes = [x.key, y.key];
    const { datasets } = this.chart.data;
    this.curves.forEach((curve, place) => {
      datasets[place].data = curve.drawn.map((row) => this.at(curve.run.rows[row]));
    });
    for (const [name, { label, unit }] of [["x", x], ["y", y]]) {
      this.chart.options.scales[name].title.text = unit ? `${label} (${unit})` : label;
    }
    this.drawSpecial();
    this.whole();
  }

  // The special points on top of all curves, or else they would be hidden where they meet.
  drawSpecial() {
    this.special.data = [];
    this.special.pointStyle = [];
    for (const { run, places } of this.curves.filter(({ hidden }) => !hidden)) {
      for (const row of places.map((place) => run.rows[place])) {
        if (row.special === null) continue;
        const isFold = run.special[row.special]?.kind === "fold";
        this.special.data.push(this.at(row));
        this.special.pointStyle.push(isFold ? "triangle" : "rectRot");
      }
    }
  }

  at(row) {
    const [x, y] = this.axes;
    return { x: row[x], y: row[y] ?? NaN };
  }

  // Show all of it, with a margin.
  whole() {
    for (const name of ["x", "y"]) {
      const values = this.curves.flatMap(({ run, places }) =>
        places.map((place) => this.at(run.rows[place])[name]).filter(Number.isFinite));
      // Not by spreading: an argument list has its limits.
      const low = values.reduce((a, b) => Math.min(a, b), Infinity);
      const high = values.reduce((a, b) => Math.max(a, b), -Infinity);
      const margin = 0.04 * (high - low) || 0.04 * Math.abs(high) || 1;
      const limits = values.length ? { min: low - margin, max: high + margin } : {};
      Object.assign(this.chart.options.scales[name], limits);
    }
    this.chart.update("none");
  }

  // The point shown: ring it, and bring it into sight.
  mark(row) {
    const point = this.at(row);
    this.ring.data = [point];
    this.chart.update("none");
    for (const name of ["x", "y"]) {
      const { min, max } = this.chart.scales[name];
      if (point[name] < min || point[name] > max) {
        const half = (max - min) / 2;
        const range = { min: point[name] - half, max: point[name] + half };
        this.chart.zoomScale(name, range, "none");
      }
    }
  }

  setVisible(curve, visible) {
    curve.hidden = !visible;
    this.chart.setDatasetVisibility(this.curves.indexOf(curve), visible);
    this.drawSpecial();
    this.chart.update("none");
  }

  // All points at the place nearest to the click, whichever curves they belong to.
  pick(event) {
    const points = [];
    this.curves.forEach((curve, number) => {
      if (curve.hidden) return;
      const drawn = this.chart.getDatasetMeta(number).data;
      for (const place of curve.places) {
        const { x, y } = drawn[curve.drawn.indexOf(place)];
        const away = Math.hypot(x - event.x, y - event.y);
        if (Number.isFinite(away)) points.push({ curve, place, away });
      }
    });
    const nearest = Math.min(...points.map(({ away }) => away));
    const hits = points.filter(({ away }) => away < nearest + Diagram.TOGETHER);
    if (hits.length) this.onPick(hits);
  }

  // Squared distance of two rows on the screen.
  distance(a, b) {
    const [p, q] = [a, b].map((row) => this.at(row));
    const { x, y } = this.chart.scales;
    return (x.getPixelForValue(p.x) - x.getPixelForValue(q.x)) ** 2
      + (y.getPixelForValue(p.y) - y.getPixelForValue(q.y)) ** 2;
  }
}
