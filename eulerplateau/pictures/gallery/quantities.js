// The quantities of a row in the order shown, by what a run follows: its column, what it is
// called, its unit, and the axis of the diagram that offers it. The loads have a symbol for
// the headline; which of them is the run's own, the gallery's data say.

const QUANTITIES = {
  film: [
    { key: "kL3_alpha", label: "spring load kL³/α", symbol: "kL³/α", axis: "x" },
    { key: "sigma_hat", label: "tension σ̂", symbol: "σ̂", axis: "x" },
    { key: "link", label: "link", symbol: "Lk", axis: "x" },
    { key: "twist_ratio", label: "rigidities C/B", symbol: "C/B", axis: "x" },
    { key: "length_m", label: "length", symbol: "L", axis: "x" },
    { key: "surface_tension_N_per_m", label: "surface tension", symbol: "γ", axis: "x" },
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
  ],
  cell: [
    { key: "sigma_hat", label: "contractility σ̂", symbol: "σ̂", axis: "x" },
    { key: "ks_hat", label: "stiffness k̂ₛ", symbol: "k̂ₛ", axis: "x" },
    { key: "beta_hat", label: "line tension β̂" },
    { key: "perimeter", label: "perimeter", unit: "R₀", axis: "y" },
    { key: "traction", label: "mean traction", unit: "α/R₀²", axis: "y" },
    { key: "largest_traction", label: "largest traction", unit: "α/R₀²", axis: "y" },
    { key: "extension", label: "mean extension", unit: "R₀", axis: "y" },
    { key: "kappa_mid", label: "curvature mid-side", unit: "1/R₀", axis: "y" },
    { key: "kappa_adhesion", label: "curvature at adhesions", unit: "1/R₀", axis: "y" },
    { key: "area", label: "area", unit: "R₀²", axis: "y" },
    { key: "energy", label: "energy E", unit: "α/R₀", axis: "y" },
    { key: "n_unstable", label: "unstable modes" },
    { key: "lowest_eigenvalue", label: "lowest eigenvalue", unit: "α/R₀⁴", axis: "y" },
    { key: "status", label: "status" },
    { key: "step", label: "step" },
  ],
};
