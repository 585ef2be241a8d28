//! Clear-sky radiance and the sun's after Preetham, Shirley and Smits 1999, "A Practical Analytic Model for Daylight".
//!
//! Sky: luminance and chromaticity by Perez's function and the paper's zenith values (appendix 2), made a spectrum by the
//! components of CIE daylight that have this chromaticity. Sun: a black body of [`SUN_KELVIN`] through Rayleigh scattering, an aerosol of Ångström exponent 1.3 (appendix 1)
//! and 0.35 cm of ozone, whose coefficients are Leckner's of 1978; the bands of water and oxygen beyond 690 nm are left out.
//! Angles as in [`crate::sky`]. The paper's fit is for turbidities of 2 to 6.

use std::f64::consts::PI;
use std::sync::LazyLock;

use crate::daylight::components;
use crate::sky::{SUN_KELVIN, TURBIDITY};
use crate::{DenseSpectrum, SampledSpectrum, SampledWavelengths, planck, xyz_of_radiance};

/// Rows: A to E of Perez's function; columns: factor of the turbidity, constant. For luminance, x, y.
const PEREZ: [[[f64; 2]; 5]; 3] = [
    [[0.1787, -1.4630], [-0.3554, 0.4275], [-0.0227, 5.3251], [0.1206, -2.5771], [-0.0670, 0.3703]],
    [[-0.0193, -0.2592], [-0.0665, 0.0008], [-0.0004, 0.2125], [-0.0641, -0.8989], [-0.0033, 0.0452]],
    [[-0.0167, -0.2608], [-0.0950, 0.0092], [-0.0079, 0.2102], [-0.0441, -1.6537], [-0.0109, 0.0529]],
];

/// Chromaticity at the zenith: rows for T^2, T, 1; columns for powers 3 to 0 of the sun's angle from the zenith. For x, y.
const ZENITH: [[[f64; 4]; 3]; 2] = [
    [[0.00166, -0.00375, 0.00209, 0.0], [-0.02903, 0.06377, -0.03202, 0.00394], [0.11693, -0.21196, 0.06052, 0.25886]],
    [[0.00275, -0.00610, 0.00317, 0.0], [-0.04214, 0.08970, -0.04153, 0.00516], [0.15346, -0.26756, 0.06670, 0.26688]],
];

/// Absorption of ozone in the visible, per cm at 0 degrees C and 1 atm, from 450 nm every 10 nm.
const OZONE: [f64; 33] = [
    0.003, 0.006, 0.009, 0.014, 0.021, 0.030, 0.040, 0.048, 0.063, 0.075, 0.085, 0.103, 0.120, 0.120, 0.115, 0.125,
    0.120, 0.105, 0.090, 0.079, 0.067, 0.057, 0.048, 0.036, 0.028, 0.023, 0.018, 0.014, 0.011, 0.010, 0.009, 0.007,
    0.004,
];

const OZONE_CM: f64 = 0.35;

/// Candela per square metre in a unit of the luminance fit.
const KILO: f64 = 1000.0;

/// The components of daylight, and their luminances.
static DAYLIGHT: LazyLock<([DenseSpectrum; 3], [f64; 3])> = LazyLock::new(|| {
    let spectra = components();
    let luminances = std::array::from_fn(|i| xyz_of_radiance(&spectra[i])[1]);
    (spectra.map(|spectrum| DenseSpectrum::new(&spectrum)), luminances)
});

/// The sky for one position of the sun.
#[derive(Clone, Debug)]
pub struct PreethamSky {
    /// A to E for luminance, x, y.
    perez: [[f64; 5]; 3],
    /// Luminance (cd m^-2), x, y at the zenith over Perez's function there.
    scale: [f64; 3],
    turbidity: f64,
    sun_cos: f64,
}

fn perez(p: &[f64; 5], cos_theta: f64, gamma: f64) -> f64 {
    let [a, b, c, d, e] = *p;
    let cos_gamma = gamma.cos();
    (1.0 + a * (b / cos_theta).exp()) * (1.0 + c * (d * gamma).exp() + e * cos_gamma * cos_gamma)
}

impl PreethamSky {
    /// `turbidity` is limited to [`TURBIDITY`], `sun_elevation` to 0 to π/2 radians.
    pub fn new(turbidity: f64, sun_elevation: f64) -> PreethamSky {
        let t = turbidity.clamp(TURBIDITY[0], TURBIDITY[1]);
        let theta_sun = 0.5 * PI - sun_elevation.clamp(0.0, 0.5 * PI);
        let perez_parameters = PEREZ.map(|rows| rows.map(|[slope, constant]| slope * t + constant));
        let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * theta_sun);
        let luminance = KILO * ((4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192).max(0.0);
        let chromaticity = ZENITH.map(|rows| {
            let cubic = |row: [f64; 4]| row.iter().fold(0.0, |sum, c| sum * theta_sun + c);
            (cubic(rows[0]) * t + cubic(rows[1])) * t + cubic(rows[2])
        });
        let zenith = [luminance, chromaticity[0], chromaticity[1]];
        let scale = std::array::from_fn(|i| zenith[i] / perez(&perez_parameters[i], 1.0, theta_sun));
        PreethamSky { perez: perez_parameters, scale, turbidity: t, sun_cos: theta_sun.cos() }
    }

    /// Luminance in cd m^-2, and chromaticity x, y. Zero below the horizon.
    pub fn luminance_xy(&self, cos_theta: f64, gamma: f64) -> [f64; 3] {
        if cos_theta < 0.0 {
            return [0.0; 3];
        }
        // At the horizon itself the function has its limit.
        let at = |i: usize| self.scale[i] * perez(&self.perez[i], cos_theta.max(1e-4), gamma);
        [at(0).max(0.0), at(1), at(2)]
    }

    /// Radiance, W m^-2 sr^-1 nm^-1.
    #[inline]
    pub fn sample(&self, cos_theta: f64, gamma: f64, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        if cos_theta < 0.0 {
            return SampledSpectrum::ZERO;
        }
        let [luminance, x, y] = self.luminance_xy(cos_theta, gamma);
        let m = 0.0241 + 0.2562 * x - 0.7341 * y;
        let m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
        let m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
        let (spectra, luminances) = &*DAYLIGHT;
        let factor = luminance / (luminances[0] + m1 * luminances[1] + m2 * luminances[2]);
        if !(factor.is_finite() && factor > 0.0) {
            return SampledSpectrum::ZERO;
        }
        let [s0, s1, s2] = [0, 1, 2].map(|i: usize| spectra[i].sample(wavelengths));
        let sum = s0 * factor as f32 + s1 * (factor * m1) as f32 + s2 * (factor * m2) as f32;
        sum.map(|value| value.max(0.0))
    }

    /// Radiance at one wavelength.
    pub fn radiance(&self, cos_theta: f64, gamma: f64, lambda_nm: f64) -> f64 {
        f64::from(self.sample(cos_theta, gamma, &SampledWavelengths::fixed([lambda_nm; 4])).hero())
    }

    /// Share of the sun's light that reaches the ground.
    pub fn sun_transmittance(&self, lambda_nm: f64) -> f64 {
        let um = lambda_nm / 1000.0;
        let degrees = self.sun_cos.clamp(0.0, 1.0).acos().to_degrees();
        let mass = 1.0 / (self.sun_cos + 0.15 * (93.885 - degrees).powf(-1.253));
        let aerosol = (0.04608 * self.turbidity - 0.04586).max(0.0) * um.powf(-1.3);
        (-mass * (0.008735 * um.powf(-4.08) + aerosol + ozone(lambda_nm) * OZONE_CM)).exp()
    }

    /// Radiance of the sun's disc, the same all over it.
    pub fn solar_radiance(&self, lambda_nm: f64) -> f64 {
        planck(lambda_nm, SUN_KELVIN) * self.sun_transmittance(lambda_nm)
    }
}

/// Per cm.
fn ozone(lambda_nm: f64) -> f64 {
    let x = (lambda_nm - 450.0) / 10.0;
    let last = OZONE.len() - 1;
    if x <= -1.0 || x >= last as f64 + 1.0 {
        return 0.0;
    }
    let at = |i: f64| if i < 0.0 || i > last as f64 { 0.0 } else { OZONE[i as usize] };
    at(x.floor()) + (at(x.floor() + 1.0) - at(x.floor())) * (x - x.floor())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Spectrum, chromaticity};

    fn spectrum(sky: &PreethamSky, cos_theta: f64, gamma: f64) -> Spectrum {
        let lambda_nm: Vec<f64> = (360..=830).map(f64::from).collect();
        let values: Vec<f64> = lambda_nm.iter().map(|l| sky.radiance(cos_theta, gamma, *l)).collect();
        Spectrum::Tabulated { lambda_nm: lambda_nm.into(), values: values.into() }
    }

    /// The spectra have the luminance and the chromaticity that the model's formulas give.
    #[test]
    fn spectra_have_the_luminance_and_colour_of_the_formulas() {
        for (turbidity, elevation) in [(2.0, 0.9), (3.5, 0.4), (6.0, 1.3)] {
            let sky = PreethamSky::new(turbidity, elevation);
            for (cos_theta, gamma) in [(1.0, 0.5 * PI - elevation), (0.3, 1.4), (0.7, 0.4)] {
                let [luminance, x, y] = sky.luminance_xy(cos_theta, gamma);
                let xyz = xyz_of_radiance(&spectrum(&sky, cos_theta, gamma));
                let [got_x, got_y] = chromaticity(xyz);
                assert!((xyz[1] / luminance - 1.0).abs() < 1e-3, "{} instead of {luminance}", xyz[1]);
                assert!((got_x - x).abs() < 2e-3 && (got_y - y).abs() < 2e-3, "{got_x} {got_y} instead of {x} {y}");
            }
        }
    }

    /// Zenith luminance by the formula with numbers put in by hand: T = 2, sun at 45 degrees:
    /// chi = (4/9 - 1/60) pi/2 = 0.67195, tan 0.79544, (8.0906 - 4.971) 0.79544 - 0.431 + 2.4192 = 4.4696 kcd m^-2.
    #[test]
    fn the_zenith_is_as_bright_as_the_paper_says() {
        let sky = PreethamSky::new(2.0, 0.25 * PI);
        let [luminance, x, y] = sky.luminance_xy(1.0, 0.25 * PI);
        assert!((luminance - 4469.6).abs() < 1.0, "{luminance}");
        assert!(x < 0.27 && y < 0.28, "a blue zenith: {x} {y}");
    }

    /// The sun's disc gives some 1000 W m^-2 of the 1366 outside, over the wavelengths of the tables a good half of that; it is redder when low.
    #[test]
    fn the_sun_is_bright_and_redder_when_low() {
        let (high, low) = (PreethamSky::new(2.5, 1.4), PreethamSky::new(2.5, 0.1));
        let solid_angle = PI * crate::sky::SOLAR_RADIUS * crate::sky::SOLAR_RADIUS;
        let irradiance: f64 = (300..1100).map(|l| high.solar_radiance(f64::from(l)) * solid_angle).sum();
        assert!((700.0..900.0).contains(&irradiance), "{irradiance}");
        let ratio = |sky: &PreethamSky| sky.solar_radiance(450.0) / sky.solar_radiance(650.0);
        assert!(ratio(&low) < 0.35 * ratio(&high));
    }

    #[test]
    fn every_angle_gives_finite_radiance() {
        for turbidity in [1.0, 2.0, 6.0, 10.0] {
            for elevation in [0.0, 0.01, 0.8, 0.5 * PI] {
                let sky = PreethamSky::new(turbidity, elevation);
                for (i, gamma) in [0.0, 0.3, 1.5, PI].into_iter().enumerate() {
                    for lambda in [250.0, 380.0, 550.0, 1000.0] {
                        let value = sky.radiance(0.3 * i as f64, gamma, lambda) + sky.solar_radiance(lambda);
                        assert!(value.is_finite() && value >= 0.0);
                    }
                }
                assert_eq!(sky.radiance(-0.1, 1.0, 550.0), 0.0);
            }
        }
    }
}
