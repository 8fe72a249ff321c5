// What the page uses of its libraries; `npm ci && npm run build` makes libraries.min.js.
import {
  Chart,
  LinearScale,
  LineElement,
  PointElement,
  ScatterController,
} from "chart.js";
import zoom from "chartjs-plugin-zoom";

Chart.register(LinearScale, LineElement, PointElement, ScatterController, zoom);

export { Chart };
export {
  AmbientLight,
  BackSide,
  BufferAttribute,
  BufferGeometry,
  CatmullRomCurve3,
  Color,
  DirectionalLight,
  DynamicDrawUsage,
  FrontSide,
  Mesh,
  MeshPhongMaterial,
  OrthographicCamera,
  Scene,
  TubeGeometry,
  Vector3,
  WebGLRenderer,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
