//! Thermal emission of a black body.
//!
//! Planck's law for spectral radiance, L(lambda, T) = 2 h c^2 / lambda^5 / (exp(h c / (lambda k T)) - 1), with the
//! exact constants of the 2019 SI, per nanometre of vacuum wavelength.

const PLANCK: f64 = 6.626_070_15e-34;
const LIGHT_SPEED: f64 = 299_792_458.0;
const BOLTZMANN: f64 = 1.380_649e-23;

/// Spectral radiance of a black body in W m^-2 sr^-1 nm^-1; zero where `kelvin` or `lambda_nm` is not positive.
pub fn planck(lambda_nm: f64, kelvin: f64) -> f64 {
    if !(kelvin > 0.0 && lambda_nm > 0.0) {
        return 0.0;
    }
    let lambda = lambda_nm * 1e-9;
    let exponent = PLANCK * LIGHT_SPEED / (lambda * BOLTZMANN * kelvin);
    let per_metre = 2.0 * PLANCK * LIGHT_SPEED * LIGHT_SPEED / (lambda.powi(5) * exponent.exp_m1());
    per_metre * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stefan and Boltzmann: the integral over all wavelengths is sigma T^4 / pi.
    #[test]
    fn integrates_to_the_stefan_boltzmann_law() {
        const SIGMA: f64 = 5.670_374_419e-8;
        for kelvin in [1500.0, 5800.0] {
            // Midpoint rule in log lambda from 10 nm to 1 mm.
            let (low, high, n) = (10f64.ln(), 1e6f64.ln(), 20_000);
            let step = (high - low) / n as f64;
            let sum: f64 = (0..n)
                .map(|i| (low + (i as f64 + 0.5) * step).exp())
                .map(|lambda| planck(lambda, kelvin) * lambda * step)
                .sum();
            let expected = SIGMA * kelvin.powi(4) / std::f64::consts::PI;
            assert!((sum / expected - 1.0).abs() < 1e-4, "{kelvin} K: {sum} instead of {expected}");
        }
    }

    /// Wien: the maximum lies at 2 897 771.955 nm K / T.
    #[test]
    fn peaks_where_wien_says() {
        let peak = 2_897_771.955 / 5000.0;
        assert!(planck(peak, 5000.0) > planck(peak - 1.0, 5000.0));
        assert!(planck(peak, 5000.0) > planck(peak + 1.0, 5000.0));
    }

    #[test]
    fn nothing_shines_at_absolute_zero_or_below() {
        assert_eq!(planck(500.0, 0.0), 0.0);
        assert_eq!(planck(500.0, -10.0), 0.0);
        assert_eq!(planck(500.0, f64::NAN), 0.0);
        assert_eq!(planck(360.0, 1.0), 0.0);
    }
}
