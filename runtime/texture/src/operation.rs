//! The operations of expressions on numbers.

/// What the surface gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Input {
    /// The point in the space in which the material was attached.
    X,
    Y,
    Z,
    /// The point in the world.
    WorldX,
    WorldY,
    WorldZ,
    /// Surface coordinates.
    U,
    V,
    /// Unit normal, outwards, in the space in which the material was attached.
    NormalX,
    NormalY,
    NormalZ,
    /// Unit normal, outwards, in the world.
    WorldNormalX,
    WorldNormalY,
    WorldNormalZ,
    /// Colour of a mesh's vertices, interpolated: linear sRGB; white where there is none.
    Red,
    Green,
    Blue,
}

impl Input {
    pub const ALL: [Input; 17] = {
        use Input::*;
        [
            X,
            Y,
            Z,
            WorldX,
            WorldY,
            WorldZ,
            U,
            V,
            NormalX,
            NormalY,
            NormalZ,
            WorldNormalX,
            WorldNormalY,
            WorldNormalZ,
            Red,
            Green,
            Blue,
        ]
    };

    pub const fn name(self) -> &'static str {
        match self {
            Input::X => "x",
            Input::Y => "y",
            Input::Z => "z",
            Input::WorldX => "world_x",
            Input::WorldY => "world_y",
            Input::WorldZ => "world_z",
            Input::U => "u",
            Input::V => "v",
            Input::NormalX => "normal_x",
            Input::NormalY => "normal_y",
            Input::NormalZ => "normal_z",
            Input::WorldNormalX => "world_normal_x",
            Input::WorldNormalY => "world_normal_y",
            Input::WorldNormalZ => "world_normal_z",
            Input::Red => "red",
            Input::Green => "green",
            Input::Blue => "blue",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    Negate,
    Abs,
    Floor,
    /// 0 for negative numbers.
    Sqrt,
    /// At most the largest number.
    Exp,
    /// That of the smallest normal number for what is not above it.
    Ln,
    Sin,
    Cos,
    /// Of the argument limited to [-1, 1].
    Asin,
    Acos,
    Not,
}

impl Unary {
    pub const ALL: [Unary; 11] = {
        use Unary::*;
        [Negate, Abs, Floor, Sqrt, Exp, Ln, Sin, Cos, Asin, Acos, Not]
    };

    pub const fn name(self) -> &'static str {
        match self {
            Unary::Negate => "negate",
            Unary::Abs => "abs",
            Unary::Floor => "floor",
            Unary::Sqrt => "sqrt",
            Unary::Exp => "exp",
            Unary::Ln => "ln",
            Unary::Sin => "sin",
            Unary::Cos => "cos",
            Unary::Asin => "asin",
            Unary::Acos => "acos",
            Unary::Not => "not",
        }
    }

    #[inline]
    pub fn apply(self, a: f64) -> f64 {
        match self {
            Unary::Negate => -a,
            Unary::Abs => a.abs(),
            Unary::Floor => a.floor(),
            Unary::Sqrt => a.max(0.0).sqrt(),
            Unary::Exp => a.exp().min(f64::MAX),
            Unary::Ln => a.max(f64::MIN_POSITIVE).ln(),
            Unary::Sin => a.sin(),
            Unary::Cos => a.cos(),
            Unary::Asin => a.clamp(-1.0, 1.0).asin(),
            Unary::Acos => a.clamp(-1.0, 1.0).acos(),
            Unary::Not => f64::from(a == 0.0),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    /// By zero: 0.
    Divide,
    /// What is left after the largest multiple of |b| that is not above a, within [0, |b|); 0 for b = 0.
    Modulo,
    /// 0 where the power is no finite number.
    Power,
    Min,
    Max,
    /// The angle of the point (b, a) from the x axis; 0 for the origin.
    Atan2,
    Less,
    LessOrEqual,
    Equal,
    And,
    Or,
}

impl Binary {
    pub const ALL: [Binary; 14] = {
        use Binary::*;
        [Add, Subtract, Multiply, Divide, Modulo, Power, Min, Max, Atan2, Less, LessOrEqual, Equal, And, Or]
    };

    pub const fn name(self) -> &'static str {
        match self {
            Binary::Add => "add",
            Binary::Subtract => "subtract",
            Binary::Multiply => "multiply",
            Binary::Divide => "divide",
            Binary::Modulo => "modulo",
            Binary::Power => "power",
            Binary::Min => "min",
            Binary::Max => "max",
            Binary::Atan2 => "atan2",
            Binary::Less => "less",
            Binary::LessOrEqual => "less_or_equal",
            Binary::Equal => "equal",
            Binary::And => "and",
            Binary::Or => "or",
        }
    }

    #[inline]
    pub fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Binary::Add => limited(a + b),
            Binary::Subtract => limited(a - b),
            Binary::Multiply => limited(a * b),
            Binary::Divide if b == 0.0 => 0.0,
            Binary::Divide => limited(a / b),
            Binary::Modulo => modulo(a, b),
            Binary::Power => {
                let power = a.powf(b);
                if power.is_finite() { power } else { 0.0 }
            }
            Binary::Min => a.min(b),
            Binary::Max => a.max(b),
            Binary::Atan2 => a.atan2(b),
            Binary::Less => f64::from(a < b),
            Binary::LessOrEqual => f64::from(a <= b),
            Binary::Equal => f64::from(a == b),
            Binary::And => f64::from(a != 0.0 && b != 0.0),
            Binary::Or => f64::from(a != 0.0 || b != 0.0),
        }
    }

    pub const fn commutes(self) -> bool {
        matches!(
            self,
            Binary::Add | Binary::Multiply | Binary::Min | Binary::Max | Binary::Equal | Binary::And | Binary::Or
        )
    }
}

/// Overflow stops at the largest numbers. Sums, products and quotients of finite numbers are never NaN but for 0 / 0.
#[inline]
fn limited(x: f64) -> f64 {
    x.clamp(-f64::MAX, f64::MAX)
}

fn modulo(a: f64, b: f64) -> f64 {
    let rest = a.rem_euclid(b);
    // Rounding may reach the divisor for a tiny negative a; b = 0 gives NaN.
    if rest < b.abs() { rest } else { 0.0 }
}
