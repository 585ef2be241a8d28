//! Reconstruction filters.

use arsc_ir::Filter;

use super::{Builtin, Param};
use crate::eval::Eval;
use crate::types::Type::{self, Float};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    let pixels = |name, doc, value| Param::new(name, Float, doc).float(value).positive();
    vec![
        Builtin::new("box_filter", "Constant within its radius.")
            .param(pixels("radius", "pixels", 0.5))
            .runs(Type::Filter, |_, a, _| filter(Filter::Box { radius: a[0].as_float() })),
        Builtin::new("tent", "Falls linearly to 0 at its radius.")
            .param(pixels("radius", "pixels", 1.0))
            .runs(Type::Filter, |_, a, _| filter(Filter::Tent { radius: a[0].as_float() })),
        Builtin::new("gaussian", "A bell curve, shifted to reach 0 at its radius.")
            .param(pixels("radius", "pixels", 1.5))
            .param(pixels("sigma", "standard deviation, pixels", 0.5))
            .runs(Type::Filter, |_, a, _| filter(Filter::Gaussian { radius: a[0].as_float(), sigma: a[1].as_float() })),
        Builtin::new("mitchell", "Mitchell and Netravali 1988. Negative lobes: crisper, and noisier.")
            .param(pixels("radius", "pixels", 2.0))
            .param(Param::new("b", Float, "blur").default_value("1/3", Value::Float(1.0 / 3.0)).within(0.0, 1.0))
            .param(Param::new("c", Float, "ringing").default_value("1/3", Value::Float(1.0 / 3.0)).within(0.0, 1.0))
            .runs(Type::Filter, |_, a, _| {
                filter(Filter::Mitchell { radius: a[0].as_float(), b: a[1].as_float(), c: a[2].as_float() })
            }),
        Builtin::new("lanczos", "A sinc windowed by its main lobe. Negative lobes: crisper, and noisier.")
            .param(Param::new("radius", Float, "pixels, which is the number of lobes").float(3.0).within(1.0, 16.0))
            .runs(Type::Filter, |_, a, _| filter(Filter::Lanczos { radius: a[0].as_float() })),
    ]
}

fn filter(filter: Filter) -> Eval {
    Ok(Value::Filter(filter.into()))
}
