// The film in 3D: blue in front, orange behind, its loop a tube, on one that resists twist a
// stripe; one scale for all shapes.

class Film {
  static STRIPE = "#F7F7F7";

  // A scale bar is about so wide, in pixels, and one of these parts of the unit of length.
  static BAR = 64;
  static PARTS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

  // `colours` are those of front, back and loop. `eye` points from the film to the camera; at
  // first it sees `halfSize` [across, up], in the unit in which `size` is the length of a
  // loop; no tube is thicker than `radius`. `onView` is called when the view has changed.
  constructor(canvas, { colours, eye, halfSize, size, radius, antialias = true }, onView) {
    const L = Libraries;
    const [front, back, loop] = colours;
    this.onView = onView;
    this.halfSize = halfSize;
    this.largestRadius = radius;
    this.canvas = canvas;
    this.renderer = new L.WebGLRenderer({ canvas, antialias });
    this.renderer.setClearColor("#ffffff");
    this.scene = new L.Scene();
    this.scene.add(new L.AmbientLight("#ffffff", 2.2));
    // Parallel rays and no perspective, so that sizes compare.
    this.camera = new L.OrthographicCamera(-1, 1, 1, -1, 0, 2 * size);
    this.camera.up.set(0, 0, 1);
    const light = new L.DirectionalLight("#ffffff", 0.95);
    light.position.set(0, 0, 1);
    this.camera.add(light, light.target);
    this.scene.add(this.camera);
    this.parts = [];
    for (const [color, side] of [[front, L.FrontSide], [back, L.BackSide]]) {
      const material = new L.MeshPhongMaterial({ color, side, specular: "#222222" });
      this.parts.push(new L.Mesh(new L.BufferGeometry(), material));
    }
    this.tube = new L.Mesh(
      new L.BufferGeometry(), new L.MeshPhongMaterial({ color: loop }));
    this.stripe = new L.Mesh(
      new L.BufferGeometry(), new L.MeshPhongMaterial({ color: Film.STRIPE }));
    this.scene.add(...this.parts, this.tube, this.stripe);
    this.far = size; // beyond any film
    this.detail = 1;
    this.camera.position.fromArray(eye).setLength(this.far);
    this.controls = new L.OrbitControls(this.camera, canvas);
    this.controls.minZoom = 0.5;
    this.controls.maxZoom = 50;
    this.controls.addEventListener("change", () => this.draw());
    this.controls.update();
    this.controls.saveState();
    new ResizeObserver(() => this.fit()).observe(canvas.parentElement);
  }

  show(mesh, triangles, x, marks, radius) {
    const L = Libraries;
    if (triangles !== this.triangles) {
      this.triangles = triangles;
      this.parts[0].geometry.dispose();
      const sheet = new L.BufferGeometry();
      sheet.setIndex(new L.BufferAttribute(triangles, 1));
      for (const part of this.parts) part.geometry = sheet;
    }
    const sheet = this.parts[0].geometry;
    sheet.setAttribute("position", new L.BufferAttribute(x, 3));
    sheet.computeVertexNormals();
    sheet.computeBoundingSphere();
    const corners = Array.from(mesh.loop, (v) => new L.Vector3().fromArray(x, 3 * v));
    const wire = new L.CatmullRomCurve3(corners, true);
    this.tube.geometry.dispose();
    this.tube.geometry = new L.TubeGeometry(wire, 2 * corners.length, radius, 12, true);
    this.mark(corners, marks, radius);
    this.draw();
  }

  // A stripe along the tube where directions across its edges point, from the first vertex
  // round to it; open, as the ends of a rod that was turned need not meet where it was welded.
  mark(corners, marks, radius) {
    const L = Libraries;
    this.stripe.visible = marks !== null;
    if (!marks) return;
    const n = corners.length;
    const across = corners.map((_, edge) => new L.Vector3().fromArray(marks, 3 * edge));
    const beyond = (edge, next) =>
      across[edge].clone().multiplyScalar(1.5).addScaledVector(across[next], -0.5);
    const on = (place, direction) =>
      place.clone().add(direction.clone().setLength(0.8 * radius));
    const points = [
      on(corners[0], beyond(0, 1)),
      ...corners.map((corner, edge) =>
        on(corner.clone().lerp(corners[(edge + 1) % n], 0.5), across[edge])),
      on(corners[0], beyond(n - 1, n - 2)),
    ];
    const line = new L.CatmullRomCurve3(points);
    this.stripe.geometry.dispose();
    this.stripe.geometry = new L.TubeGeometry(line, 4 * points.length, 0.4 * radius, 8);
  }

  firstView() {
    this.controls.reset();
  }

  // From above the plane next to the shape, whose `normal` is of either sign; all of it.
  above(normal) {
    const way = new Libraries.Vector3().fromArray(normal);
    if (way.dot(this.camera.position) < 0) way.negate();
    this.camera.position.copy(this.controls.target).addScaledVector(way, this.far);
    this.controls.update();
    this.camera.zoom = Math.min(this.camera.zoom, this.room());
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  // The zoom at which all of the shape is just in the picture.
  room() {
    this.camera.updateMatrixWorld();
    const points = this.parts[0].geometry.getAttribute("position");
    const point = new Libraries.Vector3();
    let [across, up] = [0, 0];
    for (let v = 0; v < points.count; v++) {
      point.fromBufferAttribute(points, v).applyMatrix4(this.camera.matrixWorldInverse);
      across = Math.max(across, Math.abs(point.x));
      up = Math.max(up, Math.abs(point.y));
    }
    const { right, top } = this.camera;
    const free = 1.05 * this.largestRadius;
    return Math.min(right / (1.05 * across + free), top / (1.05 * up + free));
  }

  // How high above that plane the eye is, in degrees.
  height(normal) {
    const way = this.camera.getWorldDirection(new Libraries.Vector3());
    const sine = Math.abs(way.dot(new Libraries.Vector3().fromArray(normal)));
    return Math.round(Math.asin(Math.min(1, sine)) * 180 / Math.PI);
  }

  // A length that is about as long as BAR: into how many parts the unit of length is to be
  // divided for it, and how many pixels it takes.
  bar() {
    const { left, right, zoom } = this.camera;
    const pixels = this.canvas.clientWidth * zoom / (right - left);
    const parts = Film.PARTS.find((count) => pixels / count <= Film.BAR) ?? Film.PARTS.at(-1);
    return { parts, pixels: pixels / parts };
  }

  // Writes to #bar, #length and #angle how long things are and from where they are seen;
  // `unit` is the unit of length's name.
  tellScale(find, unit, normal) {
    const { parts, pixels } = this.bar();
    find("bar").style.width = `${pixels}px`;
    find("length").textContent = parts === 1 ? unit : `${unit}/${parts}`;
    const height = this.height(normal);
    find("angle").textContent = height === 90 ? "seen from above" : `${height}° above its plane`;
  }

  fit() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.setPixels();
    this.renderer.setSize(width, height, false);
    const half = 1.05 * Math.max(
      (this.halfSize[0] + this.largestRadius) / width,
      (this.halfSize[1] + this.largestRadius) / height);
    Object.assign(this.camera, {
      left: -half * width, right: half * width, top: half * height, bottom: -half * height,
    });
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  // From the next drawing on, so many pixels each way, of those that there are.
  setDetail(detail) {
    if (detail === this.detail) return;
    this.detail = detail;
    this.setPixels();
  }

  setPixels() {
    this.renderer.setPixelRatio(this.detail * Math.min(window.devicePixelRatio, 2));
  }

  draw() {
    this.renderer.render(this.scene, this.camera);
    this.onView();
  }
}
