//! Density of moist air by the CIPM-2007 formula.
//!
//! Picard, Davis, Gläser and Fujii, "Revised formula for the density of moist air (CIPM-2007)", Metrologia 45, 149 (2008). The
//! symbols are those of the paper.

/// 0 °C in kelvin. *Physics.*
const KELVIN_AT_0_C: f64 = 273.15;

/// Molar gas constant R, J/(mol K), with the value that the formula was made with. *Physics.*
const GAS_CONSTANT_J_MOL_K: f64 = 8.314472;
/// Molar mass M_a of dry air with 400 ppm carbon dioxide, kg/mol. *Physics.*
const MOLAR_MASS_DRY_KG: f64 = 28.96546e-3;
/// Molar mass M_v of water, kg/mol. *Physics.*
const MOLAR_MASS_WATER_KG: f64 = 18.01528e-3;

/// A of the saturation vapour pressure p_sv = 1 Pa · exp(A T² + B T + C + D/T), K⁻². *Physics.*
const SATURATION_A: f64 = 1.2378847e-5;
/// B of the saturation vapour pressure, K⁻¹. *Physics.*
const SATURATION_B: f64 = -1.9121316e-2;
/// C of the saturation vapour pressure. *Physics.*
const SATURATION_C: f64 = 33.93711047;
/// D of the saturation vapour pressure, K. *Physics.*
const SATURATION_D: f64 = -6.3431645e3;

/// α of the enhancement factor f = α + β p + γ t². *Physics.*
const ENHANCEMENT_ALPHA: f64 = 1.00062;
/// β of the enhancement factor, Pa⁻¹. *Physics.*
const ENHANCEMENT_BETA: f64 = 3.14e-8;
/// γ of the enhancement factor, K⁻². *Physics.*
const ENHANCEMENT_GAMMA: f64 = 5.6e-7;

/// a₀ of the compressibility Z, K/Pa. *Physics.*
const COMPRESSIBILITY_A0: f64 = 1.58123e-6;
/// a₁, Pa⁻¹. *Physics.*
const COMPRESSIBILITY_A1: f64 = -2.9331e-8;
/// a₂, K⁻¹ Pa⁻¹. *Physics.*
const COMPRESSIBILITY_A2: f64 = 1.1043e-10;
/// b₀, K/Pa. *Physics.*
const COMPRESSIBILITY_B0: f64 = 5.707e-6;
/// b₁, Pa⁻¹. *Physics.*
const COMPRESSIBILITY_B1: f64 = -2.051e-8;
/// c₀, K/Pa. *Physics.*
const COMPRESSIBILITY_C0: f64 = 1.9898e-4;
/// c₁, Pa⁻¹. *Physics.*
const COMPRESSIBILITY_C1: f64 = -2.376e-6;
/// d, K²/Pa². *Physics.*
const COMPRESSIBILITY_D: f64 = 1.83e-11;
/// e, K²/Pa². *Physics.*
const COMPRESSIBILITY_E: f64 = -0.765e-8;

/// ρ = p M_a / (Z R T) · (1 − x_v (1 − M_v/M_a)), with the mole fraction of vapour x_v = h f p_sv / p and the compressibility
/// Z = 1 − p/T (a₀ + a₁ t + a₂ t² + (b₀ + b₁ t) x_v + (c₀ + c₁ t) x_v²) + p²/T² (d + e x_v²). t is the temperature in °C, T the same
/// in kelvin, h the relative humidity from 0 to 1.
pub(super) fn density_kg_m3(temperature_c: f64, pressure_pa: f64, humidity_share: f64) -> f64 {
    let kelvin = temperature_c + KELVIN_AT_0_C;
    let saturation_pa =
        (SATURATION_A * kelvin.powi(2) + SATURATION_B * kelvin + SATURATION_C + SATURATION_D / kelvin).exp();
    let enhancement = ENHANCEMENT_ALPHA + ENHANCEMENT_BETA * pressure_pa + ENHANCEMENT_GAMMA * temperature_c.powi(2);
    let vapour = humidity_share * enhancement * saturation_pa / pressure_pa;
    let compressibility = 1.0
        - pressure_pa / kelvin
            * (COMPRESSIBILITY_A0
                + COMPRESSIBILITY_A1 * temperature_c
                + COMPRESSIBILITY_A2 * temperature_c.powi(2)
                + (COMPRESSIBILITY_B0 + COMPRESSIBILITY_B1 * temperature_c) * vapour
                + (COMPRESSIBILITY_C0 + COMPRESSIBILITY_C1 * temperature_c) * vapour.powi(2))
        + (pressure_pa / kelvin).powi(2) * (COMPRESSIBILITY_D + COMPRESSIBILITY_E * vapour.powi(2));
    pressure_pa * MOLAR_MASS_DRY_KG / (compressibility * GAS_CONSTANT_J_MOL_K * kelvin)
        * (1.0 - vapour * (1.0 - MOLAR_MASS_WATER_KG / MOLAR_MASS_DRY_KG))
}
