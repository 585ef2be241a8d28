//! Where a quadratic polynomial is not positive.

/// The set where `a t² + 2 b t + c <= 0`; ends may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Inside {
    Never,
    Always,
    /// One interval.
    Between(f64, f64),
    /// Everything but the open interval.
    Beyond(f64, f64),
}

/// Both roots without cancellation (Higham 2002, section 1.8). Double roots count as none.
pub(crate) fn not_positive(a: f64, half_b: f64, c: f64) -> Inside {
    let discriminant = half_b * half_b - a * c;
    if discriminant <= 0.0 {
        return if a < 0.0 || (a == 0.0 && c <= 0.0) { Inside::Always } else { Inside::Never };
    }
    let q = -(half_b + discriminant.sqrt().copysign(half_b));
    if a == 0.0 {
        let root = c / q;
        return if half_b > 0.0 {
            Inside::Between(f64::NEG_INFINITY, root)
        } else {
            Inside::Between(root, f64::INFINITY)
        };
    }
    let (r0, r1) = (q / a, c / q);
    let (low, high) = if r0 < r1 { (r0, r1) } else { (r1, r0) };
    if a > 0.0 { Inside::Between(low, high) } else { Inside::Beyond(low, high) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case() {
        assert_eq!(not_positive(1.0, -2.0, 3.0), Inside::Between(1.0, 3.0));
        assert_eq!(not_positive(-1.0, 2.0, -3.0), Inside::Beyond(1.0, 3.0));
        assert_eq!(not_positive(1.0, 0.0, 1.0), Inside::Never);
        assert_eq!(not_positive(-1.0, 0.0, -1.0), Inside::Always);
        assert_eq!(not_positive(1.0, 0.0, 0.0), Inside::Never);
        assert_eq!(not_positive(0.0, 1.0, -4.0), Inside::Between(f64::NEG_INFINITY, 2.0));
        assert_eq!(not_positive(0.0, -1.0, 4.0), Inside::Between(2.0, f64::INFINITY));
        assert_eq!(not_positive(0.0, 0.0, 1.0), Inside::Never);
        assert_eq!(not_positive(0.0, 0.0, 0.0), Inside::Always);
        // The small root survives beside a large one.
        assert_eq!(not_positive(1.0, -1e8, 1.0), Inside::Between(5e-9, 2e8));
    }
}
