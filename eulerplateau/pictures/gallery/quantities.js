// The quantities of a row in the order shown: its column, what it is called, its unit, and
// the axis of the diagram that offers it. The loads have a symbol for the headline; which
// of them is the film's own, the gallery's data say.

const QUANTITIES = [
  { key: "kL3_alpha", label: "spring load kL³/α", symbol: "kL³/α", axis: "x" },
  { key: "sigma_hat", label: "tension σ̂", symbol: "σ̂", axis: "x" },
  { key: "abs_kappa_n", label: "⟨|κₙ|⟩", axis: "y" },
  { key: "total_gauss_curvature", label: "⟨K⟩", axis: "y" },
  { key: "energy", label: "energy E", unit: "α/L", axis: "y" },
  { key: "waist_twist", label: "waist twist", unit: "°", axis: "y" },
  { key: "aspect", label: "aspect", axis: "y" },
  { key: "area", label: "area", unit: "L²", axis: "y" },
  { key: "n_unstable", label: "unstable modes" },
  { key: "lowest_eigenvalue", label: "lowest eigenvalue", axis: "y" },
  { key: "self_intersections", label: "self-intersections" },
  { key: "status", label: "status" },
  { key: "step", label: "step" },
];
