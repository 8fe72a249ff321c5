// The film in 3D: blue in front, orange behind, its loop a tube, on one that resists twist a
// stripe; one scale for all shapes.

class Film {
  static FRONT = "#6FB1DE";
  static BACK = "#F0A35E";
  static LOOP = "#2B2B2B";
  static STRIPE = "#F7F7F7";

  // `eye` points from the film to the camera; at first it sees `halfSize` [across, up], in
  // the unit in which `size` is the length of a loop; no tube is thicker than `radius`.
  constructor(canvas, { eye, halfSize, size, radius, antialias = true }) {
    const L = Libraries;
    this.halfSize = halfSize;
    this.largestRadius = radius;
    this.canvas = canvas;
    this.renderer = new L.WebGLRenderer({ canvas, antialias });
    this.renderer.setClearColor("#ffffff");
    this.scene = new L.Scene();
    this.scene.add(new L.AmbientLight("#ffffff", 1.7));
    // Parallel rays and no perspective, so that sizes compare.
    this.camera = new L.OrthographicCamera(-1, 1, 1, -1, 0, 2 * size);
    this.camera.up.set(0, 0, 1);
    const light = new L.DirectionalLight("#ffffff", 1.6);
    light.position.set(0, 0, 1);
    this.camera.add(light, light.target);
    this.scene.add(this.camera);
    this.parts = [];
    for (const [color, side] of [[Film.FRONT, L.FrontSide], [Film.BACK, L.BackSide]]) {
      const material = new L.MeshPhongMaterial({ color, side, specular: "#222222" });
      this.parts.push(new L.Mesh(new L.BufferGeometry(), material));
    }
    this.tube = new L.Mesh(
      new L.BufferGeometry(), new L.MeshPhongMaterial({ color: Film.LOOP }));
    this.stripe = new L.Mesh(
      new L.BufferGeometry(), new L.MeshPhongMaterial({ color: Film.STRIPE }));
    this.scene.add(...this.parts, this.tube, this.stripe);
    this.camera.position.fromArray(eye).setLength(size); // beyond any film
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

  // A stripe along the tube where directions across its edges point; open, as the ends of a
  // rod that was turned need not meet where it was welded.
  mark(corners, marks, radius) {
    const L = Libraries;
    this.stripe.visible = marks !== null;
    if (!marks) return;
    const points = corners.map((corner, edge) => {
      const across = new L.Vector3().fromArray(marks, 3 * edge).setLength(0.8 * radius);
      const next = corners[(edge + 1) % corners.length];
      return corner.clone().lerp(next, 0.5).add(across);
    });
    const line = new L.CatmullRomCurve3(points);
    this.stripe.geometry.dispose();
    this.stripe.geometry = new L.TubeGeometry(line, 4 * points.length, 0.4 * radius, 8);
  }

  firstView() {
    this.controls.reset();
  }

  fit() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
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

  draw() {
    this.renderer.render(this.scene, this.camera);
  }
}
