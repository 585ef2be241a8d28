//! Clear-sky radiance and the solar disc after Hosek and Wilkie.
//!
//! Sky: "An Analytic Model for Full Spectral Sky-Dome Radiance", SIGGRAPH 2012, equations 8 to 11. Sun: "Adding a
//! Solar Radiance Function to the Hosek Skylight Model", IEEE CG&A 2013. Conventions: θ is the angle of the viewed
//! direction from the zenith, γ its angle from the centre of the sun; radiance in W m^-2 sr^-1 nm^-1 as seen from the ground.
//!
//! The model's data end at [`BANDS`] wavelengths from 320 to 720 nm; between them radiance is linear in wavelength.
//! Beyond 720 nm, where the eye's response is below 0.2 % of its peak, it goes on as the power law through the last two bands.
//! Below 320 nm, where ozone absorbs, it falls linearly to zero at [`OZONE_EDGE_NM`].
//! Below the horizon there is no sky: radiance is zero. A sun below the horizon is taken to stand on it.

use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Wavelengths of the data: 320, 360 … 720 nm.
pub const BANDS: usize = 11;
pub(crate) const FIRST_NM: f64 = 320.0;
pub(crate) const STEP_NM: f64 = 40.0;

/// Where the ground receives no more ultraviolet from the sky.
pub const OZONE_EDGE_NM: f64 = 295.0;

/// Angular radius of the solar disc, radians: the mean apparent diameter of 1919 arc seconds. (The authors' own code
/// draws a disc of 0.51 degrees, which leaves some 8 % of the direct irradiance out.)
pub const SOLAR_RADIUS: f64 = 0.5 * 1919.0 / 3600.0 * std::f64::consts::PI / 180.0;

/// Temperature of the black body that stands for the sun where another star takes its place: the sun's effective one.
pub const SUN_KELVIN: f64 = 5778.0;

/// The range of the model's turbidity; values outside are clamped.
pub const TURBIDITY: [f64; 2] = [1.0, 10.0];

const TURBIDITIES: usize = 10;
const ALBEDOS: usize = 2;
const CONTROL_POINTS: usize = 6;
pub(crate) const PARAMETERS: usize = 9;
const PIECES: usize = 45;
const POWERS: usize = 4;
const LIMB_POWERS: usize = 6;

const PARAMETER_LEN: usize = TURBIDITIES * ALBEDOS * CONTROL_POINTS * BANDS * PARAMETERS;
const RADIANCE_LEN: usize = TURBIDITIES * ALBEDOS * CONTROL_POINTS * BANDS;
const SOLAR_LEN: usize = TURBIDITIES * PIECES * BANDS * POWERS;
const LIMB_LEN: usize = BANDS * LIMB_POWERS;

/// Layout: see stdlib/data/generate_sky.py.
struct Tables {
    parameters: Vec<f64>,
    radiance: Vec<f64>,
    solar: Vec<f64>,
    limb: Vec<f64>,
}

static TABLES: LazyLock<Tables> = LazyLock::new(|| {
    const BYTES: &[u8; 8 * (PARAMETER_LEN + RADIANCE_LEN + SOLAR_LEN + LIMB_LEN)] =
        include_bytes!("../../../stdlib/data/hosek_wilkie.bin");
    let mut numbers = BYTES.as_chunks::<8>().0.iter().map(|&bytes| f64::from_le_bytes(bytes));
    let mut take = |n: usize| numbers.by_ref().take(n).collect::<Vec<f64>>();
    Tables {
        parameters: take(PARAMETER_LEN),
        radiance: take(RADIANCE_LEN),
        solar: take(SOLAR_LEN),
        limb: take(LIMB_LEN),
    }
});

/// The sky for one position of the sun. About 2 kB; making it costs microseconds.
#[derive(Clone, Debug)]
pub struct HosekWilkieSky {
    /// A B C D E F G I H of the paper's equation 8, in the data's order.
    pub(crate) parameters: [[f64; PARAMETERS]; BANDS],
    pub(crate) radiance: [f64; BANDS],
    /// Lower turbidity of the data, and the weight of the next.
    turbidity: (usize, f64),
}

impl HosekWilkieSky {
    /// `turbidity` 1 (clear) to 10 (hazy), `ground_albedo` 0 to 1, `sun_elevation` 0 to π/2 radians; all clamped.
    pub fn new(turbidity: f64, ground_albedo: f64, sun_elevation: f64) -> HosekWilkieSky {
        let turbidity = split(turbidity.clamp(TURBIDITY[0], TURBIDITY[1]) - 1.0, TURBIDITIES);
        let albedo = split(ground_albedo.clamp(0.0, 1.0), ALBEDOS);
        let bezier = bernstein((sun_elevation.clamp(0.0, FRAC_PI_2) / FRAC_PI_2).cbrt());
        let blend = |table: &[f64], item: usize, items: usize| -> f64 {
            let mut sum = 0.0;
            for (t, t_weight) in [(turbidity.0, 1.0 - turbidity.1), (turbidity.0 + 1, turbidity.1)] {
                for (a, a_weight) in [(albedo.0, 1.0 - albedo.1), (albedo.0 + 1, albedo.1)] {
                    if t_weight * a_weight == 0.0 {
                        continue;
                    }
                    for (c, c_weight) in bezier.iter().enumerate() {
                        let at = ((t * ALBEDOS + a) * CONTROL_POINTS + c) * items + item;
                        sum += t_weight * a_weight * c_weight * table[at];
                    }
                }
            }
            sum
        };
        let tables = &*TABLES;
        HosekWilkieSky {
            parameters: std::array::from_fn(|band| {
                std::array::from_fn(|p| blend(&tables.parameters, band * PARAMETERS + p, BANDS * PARAMETERS))
            }),
            radiance: std::array::from_fn(|band| blend(&tables.radiance, band, BANDS)),
            turbidity,
        }
    }

    /// Sky radiance without the disc at the data's wavelengths; `cos_theta` of the viewed direction, `gamma` radians.
    pub fn sky_bands(&self, cos_theta: f64, gamma: f64) -> [f64; BANDS] {
        if cos_theta < 0.0 {
            return [0.0; BANDS];
        }
        let (cos_gamma, root) = (gamma.cos(), cos_theta.sqrt());
        std::array::from_fn(|band| {
            let [a, b, c, d, e, f, g, i, h] = self.parameters[band];
            let horizon = 1.0 + a * (b / (cos_theta + 0.01)).exp();
            let mie = (1.0 + cos_gamma * cos_gamma) / (1.0 + h * h - 2.0 * h * cos_gamma).powf(1.5);
            let glow = c + d * (e * gamma).exp() + f * cos_gamma * cos_gamma + g * mie + i * root;
            (horizon * glow * self.radiance[band]).max(0.0)
        })
    }

    /// Sky radiance without the disc.
    pub fn sky_radiance(&self, cos_theta: f64, gamma: f64, lambda_nm: f64) -> f64 {
        interpolate(&self.sky_bands(cos_theta, gamma), lambda_nm)
    }

    /// Radiance of the solar disc at the data's wavelengths, to be added to the sky's; zero beyond [`SOLAR_RADIUS`].
    pub fn solar_bands(&self, cos_theta: f64, gamma: f64) -> [f64; BANDS] {
        if cos_theta < 0.0 || gamma > SOLAR_RADIUS {
            return [0.0; BANDS];
        }
        let elevation = FRAC_PI_2 - cos_theta.clamp(0.0, 1.0).acos();
        let piece = (((elevation / FRAC_PI_2).cbrt() * PIECES as f64) as usize).min(PIECES - 1);
        let start = (piece as f64 / PIECES as f64).powi(3) * FRAC_PI_2;
        // Cosine of the angle between the line of sight and the sun's surface normal.
        let across = gamma.sin() / SOLAR_RADIUS.sin();
        let limb_cos = (1.0 - across * across).max(0.0).sqrt();
        let tables = &*TABLES;
        let (lower, weight) = self.turbidity;
        std::array::from_fn(|band| {
            let direct = |turbidity: usize| {
                let at = ((turbidity * PIECES + piece) * BANDS + band) * POWERS;
                polynomial(&tables.solar[at..at + POWERS], elevation - start)
            };
            let above = if weight > 0.0 { direct(lower + 1) * weight } else { 0.0 };
            let limb = polynomial(&tables.limb[band * LIMB_POWERS..(band + 1) * LIMB_POWERS], limb_cos);
            ((direct(lower) * (1.0 - weight) + above) * limb).max(0.0)
        })
    }

    /// Radiance of the solar disc, to be added to the sky's.
    pub fn solar_radiance(&self, cos_theta: f64, gamma: f64, lambda_nm: f64) -> f64 {
        interpolate(&self.solar_bands(cos_theta, gamma), lambda_nm)
    }
}

/// The value at a wavelength of values at the data's wavelengths.
pub fn interpolate(bands: &[f64; BANDS], lambda_nm: f64) -> f64 {
    let x = (lambda_nm - FIRST_NM) / STEP_NM;
    let last = BANDS - 1;
    if x <= 0.0 {
        return bands[0] * ((lambda_nm - OZONE_EDGE_NM) / (FIRST_NM - OZONE_EDGE_NM)).max(0.0);
    }
    if x >= last as f64 {
        let (before, end) = (bands[last - 1], bands[last]);
        if before <= 0.0 || end <= 0.0 {
            return end;
        }
        let end_nm = FIRST_NM + STEP_NM * last as f64;
        let exponent = (end / before).ln() / (end_nm / (end_nm - STEP_NM)).ln();
        return end * (lambda_nm / end_nm).powf(exponent);
    }
    let i = x as usize;
    bands[i] + (bands[i + 1] - bands[i]) * (x - i as f64)
}

/// Index and weight of the next for linear interpolation in a table of `len` entries.
fn split(x: f64, len: usize) -> (usize, f64) {
    let index = (x as usize).min(len - 1);
    (index, x - index as f64)
}

fn bernstein(x: f64) -> [f64; CONTROL_POINTS] {
    const BINOMIAL: [f64; CONTROL_POINTS] = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
    std::array::from_fn(|i| BINOMIAL[i] * x.powi(i as i32) * (1.0 - x).powi((CONTROL_POINTS - 1 - i) as i32))
}

fn polynomial(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_turbidity_and_its_neighbourhood_agree() {
        let at = |t: f64| HosekWilkieSky::new(t, 0.3, 0.7).sky_radiance(0.5, 0.4, 550.0);
        assert!((at(3.0) - at(3.0 + 1e-9)).abs() < 1e-8 * at(3.0));
        assert!((at(10.0) - at(10.0 - 1e-9)).abs() < 1e-8 * at(10.0));
    }

    /// Values of Mitsuba 3.9.1's own implementation (plugin `sunsky`, single precision).
    #[test]
    fn an_independent_implementation_agrees() {
        let cases = [
            (3.0, 0.3, 0.3, 0.5, [0.0957692, 0.0484406, 0.0319214, 0.0196171]),
            (3.0, 0.3, 1.5, 0.1, [0.347021, 0.301646, 0.234833, 0.161915]),
            (2.4, 0.65, 1.2, 2.0, [0.185907, 0.100235, 0.0629333, 0.0355339]),
        ];
        let elevation: f64 = 0.7;
        for (turbidity, albedo, theta, azimuth, expected) in cases {
            let sky = HosekWilkieSky::new(turbidity, albedo, elevation);
            let (theta, azimuth): (f64, f64) = (theta, azimuth);
            let cos_gamma = theta.sin() * azimuth.cos() * elevation.cos() + theta.cos() * elevation.sin();
            for (lambda, value) in [440.0, 550.0, 620.0, 700.0].into_iter().zip(expected) {
                let got = sky.sky_radiance(theta.cos(), cos_gamma.acos(), lambda);
                assert!((got / value - 1.0).abs() < 1e-5, "{got} instead of {value} at {lambda} nm");
            }
        }
    }

    #[test]
    fn the_sky_is_blue_overhead_and_brighter_near_the_sun() {
        let sky = HosekWilkieSky::new(2.5, 0.2, 0.8);
        assert!(sky.sky_radiance(0.95, 0.9, 450.0) > 2.0 * sky.sky_radiance(0.95, 0.9, 650.0));
        assert!(sky.sky_radiance(0.7, 0.05, 550.0) > 3.0 * sky.sky_radiance(0.7, 1.2, 550.0));
        assert_eq!(sky.sky_radiance(-0.01, 0.9, 550.0), 0.0);
    }

    #[test]
    fn the_disc_is_darker_at_its_limb_and_ends_there() {
        let sky = HosekWilkieSky::new(3.0, 0.2, 0.8);
        let cos_theta = (FRAC_PI_2 - 0.8).cos();
        let center = sky.solar_radiance(cos_theta, 0.0, 550.0);
        assert!(sky.solar_radiance(cos_theta, 0.99 * SOLAR_RADIUS, 550.0) < 0.8 * center);
        assert_eq!(sky.solar_radiance(cos_theta, 1.01 * SOLAR_RADIUS, 550.0), 0.0);
    }

    /// Direct normal irradiance against Planck at 5778 K through Rayleigh scattering (optical depth 0.0088 L^-4.05, L in
    /// micrometres) and an aerosol of Angstrom exponent 1.3 that makes up the turbidity at 550 nm; no ozone.
    #[test]
    fn the_sun_has_the_power_of_the_sun() {
        let (turbidity, elevation): (f64, f64) = (2.5, 0.84);
        let sky = HosekWilkieSky::new(turbidity, 0.2, elevation);
        let solid_angle = std::f64::consts::PI * SOLAR_RADIUS * SOLAR_RADIUS;
        let rayleigh = |um: f64| 0.0088 * um.powf(-4.05);
        let rings = 200;
        let (mut irradiance, mut expected) = (0.0, 0.0);
        for lambda in (320..830).map(|nm| nm as f64 + 0.5) {
            for i in 0..rings {
                let gamma = SOLAR_RADIUS * (i as f64 + 0.5) / rings as f64;
                let ring = std::f64::consts::TAU * gamma.sin() * SOLAR_RADIUS / rings as f64;
                irradiance += ring * sky.solar_radiance(elevation.sin(), gamma, lambda);
            }
            let um = lambda / 1000.0;
            let depth = rayleigh(um) + (turbidity - 1.0) * rayleigh(0.55) * (um / 0.55).powf(-1.3);
            expected += solid_angle * crate::planck(lambda, 5778.0) * (-depth / elevation.sin()).exp();
        }
        assert!((irradiance / expected - 1.0).abs() < 0.12, "{irradiance} W/m^2, expected about {expected}");
    }

    #[test]
    fn every_angle_and_parameter_gives_finite_radiance() {
        for turbidity in [1.0, 3.3, 10.0] {
            for elevation in [0.0, 0.01, 0.5, FRAC_PI_2] {
                let sky = HosekWilkieSky::new(turbidity, 1.0, elevation);
                for i in 0..=50 {
                    for gamma in [0.0, 1e-3, 0.5, 2.0, std::f64::consts::PI] {
                        for lambda in [320.0, 360.0, 555.5, 720.0, 830.0] {
                            let cos_theta = i as f64 / 50.0;
                            let sum = sky.sky_radiance(cos_theta, gamma, lambda)
                                + sky.solar_radiance(cos_theta, gamma, lambda);
                            assert!(sum.is_finite() && sum >= 0.0);
                        }
                    }
                }
            }
        }
    }
}
