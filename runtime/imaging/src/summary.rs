//! What a picture holds, in numbers.

use arsc_image::{Picture, UNIT_LUMINANCE};

#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    pub width: usize,
    pub height: usize,
    /// Number, first and last edge in nm.
    pub bands: Option<(usize, f64, f64)>,
    pub polarised: bool,
    pub channels: Vec<String>,
    /// Luminances of the finite pixels, cd m^-2: least, mean, greatest.
    pub luminance: [f64; 3],
    /// EV that the picture's log-average needs to become middle grey.
    pub ev: f64,
    /// Pixels with a colour or radiance that is not finite.
    pub not_finite: usize,
    /// Pixels with negative luminance.
    pub negative: usize,
}

pub fn summary(picture: &Picture) -> Summary {
    let finite = |p: &[f32; 3]| p.iter().all(|c| c.is_finite());
    let (mut least, mut most, mut sum, mut count) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0u64);
    for y in picture.xyz().iter().filter(|p| finite(p)).map(|p| f64::from(p[1])) {
        (least, most, sum, count) = (least.min(y), most.max(y), sum + y, count + 1);
    }
    let (bands, polarised) = match picture {
        Picture::Spectral(image) => {
            let edges = &image.band_edges_nm;
            (Some((image.bands(), edges[0], edges[edges.len() - 1])), image.stokes.is_some())
        }
        Picture::Colour(_) => (None, false),
    };
    let spectrum_is_finite = |pixel: usize| match picture {
        Picture::Spectral(image) => {
            let n = image.bands();
            image.radiance[pixel * n..(pixel + 1) * n].iter().all(|r| r.is_finite())
        }
        Picture::Colour(_) => true,
    };
    Summary {
        width: picture.width(),
        height: picture.height(),
        bands,
        polarised,
        channels: picture.channels().iter().map(|channel| channel.name.clone()).collect(),
        luminance: if count == 0 { [0.0; 3] } else { [least, sum / count as f64, most] },
        ev: arsc_spectral::tone::Exposure::Auto.ev(&crate::luminances(picture.xyz())),
        not_finite: picture.xyz().iter().enumerate().filter(|(i, p)| !finite(p) || !spectrum_is_finite(*i)).count(),
        negative: picture.xyz().iter().filter(|p| p[1] < 0.0).count(),
    }
}

impl std::fmt::Display for Summary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "{} x {} pixels", self.width, self.height)?;
        match self.bands {
            Some((1, first, last)) => writeln!(f, "1 band, {first} nm to {last} nm")?,
            Some((count, first, last)) => writeln!(f, "{count} bands, {first} nm to {last} nm")?,
            None => writeln!(f, "colours without a spectrum")?,
        }
        if self.polarised {
            writeln!(f, "polarised: S0 to S3")?;
        }
        if !self.channels.is_empty() {
            writeln!(f, "channels: {}", self.channels.join(", "))?;
        }
        let [least, mean, most] = self.luminance;
        writeln!(f, "luminance in cd/m2: least {least:.4e}, mean {mean:.4e}, greatest {most:.4e}")?;
        writeln!(f, "middle grey at {:+.2} EV; white at 0 EV is {UNIT_LUMINANCE:.0} cd/m2", self.ev)?;
        if self.not_finite > 0 {
            writeln!(f, "pixels that are not finite: {}", self.not_finite)?;
        }
        if self.negative > 0 {
            writeln!(f, "pixels with negative luminance: {}", self.negative)?;
        }
        Ok(())
    }
}
