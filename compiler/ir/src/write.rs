//! Writing calls and numbers of the text form (for the modules `print` and `shape_text`).

use std::fmt::{self, Display, Formatter, Write};

use arsc_geometry::{DAffine3, DVec3};

/// Writes `name(argument: value, …)`.
pub(crate) struct Call<'a, 'b> {
    f: &'a mut Formatter<'b>,
    empty: bool,
}

impl<'a, 'b> Call<'a, 'b> {
    pub(crate) fn new(f: &'a mut Formatter<'b>, name: &str) -> Result<Call<'a, 'b>, fmt::Error> {
        write!(f, "{name}(")?;
        Ok(Call { f, empty: true })
    }

    pub(crate) fn value(mut self, value: impl Display) -> Result<Self, fmt::Error> {
        self.separate()?;
        write!(self.f, "{value}")?;
        Ok(self)
    }

    pub(crate) fn arg(mut self, name: &str, value: impl Display) -> Result<Self, fmt::Error> {
        self.separate()?;
        write!(self.f, "{name}: {value}")?;
        Ok(self)
    }

    pub(crate) fn float(self, name: &str, value: f64) -> Result<Self, fmt::Error> {
        self.arg(name, Float(value))
    }

    pub(crate) fn point(self, name: &str, value: DVec3) -> Result<Self, fmt::Error> {
        self.arg(name, Floats(&value.to_array()))
    }

    pub(crate) fn index(self, name: &str, prefix: &str, value: Option<u32>) -> Result<Self, fmt::Error> {
        match value {
            Some(value) => self.arg(name, format_args!("{prefix}{value}")),
            None => Ok(self),
        }
    }

    pub(crate) fn map(self, map: &DAffine3) -> Result<Self, fmt::Error> {
        let columns = map.to_cols_array();
        let bits = |columns: &[f64]| -> Vec<u64> { columns.iter().map(|x| x.to_bits()).collect() };
        let identity = DAffine3::IDENTITY.to_cols_array();
        if bits(&columns) == bits(&identity) {
            Ok(self)
        } else if bits(&columns[..9]) == bits(&identity[..9]) {
            self.point("at", map.translation)
        } else {
            self.arg("map", Floats(&columns))
        }
    }

    fn separate(&mut self) -> fmt::Result {
        if !std::mem::take(&mut self.empty) {
            self.f.write_str(", ")?;
        }
        Ok(())
    }

    pub(crate) fn end(self) -> fmt::Result {
        self.f.write_char(')')
    }
}

pub(crate) struct Float(pub f64);

impl Display for Float {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

pub(crate) struct Floats<'a>(pub &'a [f64]);

impl Display for Floats<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_char('[')?;
        for (i, value) in self.0.iter().enumerate() {
            let comma = if i > 0 { ", " } else { "" };
            write!(f, "{comma}{value:?}")?;
        }
        f.write_char(']')
    }
}
