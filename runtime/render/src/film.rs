//! The film: what the samples of an image add up to.
//!
//! Per pixel: for every spectral band the sum of weighted radiance estimates and the sum of the estimates' weights, and
//! the sum of the observer's XYZ with the number of samples. A path gives four estimates, one per wavelength; each enters the
//! band that it falls into. Radiance of a band is the ratio of its two sums (so the random number of samples per band
//! cancels), XYZ is sum over the sum of the filter's weights; for filters with negative lobes bands are scaled by samples over
//! weights likewise, so that a constant picture is constant. Sums of films of disjoint samples add: films merge.
//! Pixels are stored tile by tile, so that threads own what they write. Values that are not finite or negative are
//! counted and left out. Polarised films keep sums of the Stokes parameters S1 to S3 per band as well.
//! How noisy the luminance is, [`crate::noise`] tells.

use arsc_image::{Channel, SpectralImage};
use arsc_spectral::{LUMINOUS_EFFICACY, Observer, SampledSpectrum, SampledWavelengths, WavelengthRange};

use crate::noise::{LuminanceMoments, NoiseMap, TileNoise, limited_weight};
use crate::polarisation::Stokes;

/// Side of a tile in pixels.
pub const TILE: u32 = 16;

/// Most bands of a film.
pub const MAX_BANDS: usize = 1000;

/// What a film records: equal bands over a range of wavelengths, and an observer's X, Y, Z beside them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bands {
    pub min_nm: f64,
    /// Positive.
    pub width_nm: f64,
    /// At least 1.
    pub count: usize,
    pub observer: Observer,
}

impl Default for Bands {
    /// The visible range in steps of 10 nm, and the CIE 1931 observer.
    fn default() -> Bands {
        Bands::over(&WavelengthRange::VISIBLE, 10.0, Observer::Cie1931)
    }
}

impl Bands {
    /// Bands that cover a range, of the given width (positive, nm) or as little off it as makes them equal.
    pub fn over(range: &WavelengthRange, width_nm: f64, observer: Observer) -> Bands {
        let count = (range.width_nm() / width_nm).round().clamp(1.0, MAX_BANDS as f64) as usize;
        Bands { min_nm: range.min_nm(), width_nm: range.width_nm() / count as f64, count, observer }
    }

    pub fn edges_nm(&self) -> Vec<f64> {
        (0..=self.count).map(|i| self.min_nm + i as f64 * self.width_nm).collect()
    }
}

/// Finds the band of a wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BandIndex {
    min_nm: f32,
    per_nm: f32,
    count: usize,
}

impl BandIndex {
    fn new(bands: &Bands) -> BandIndex {
        BandIndex { min_nm: bands.min_nm as f32, per_nm: (1.0 / bands.width_nm) as f32, count: bands.count }
    }

    #[inline]
    fn of(&self, lambda_nm: f32) -> Option<usize> {
        let at = (lambda_nm - self.min_nm) * self.per_nm;
        // The end of the last band belongs to it.
        (at >= 0.0 && at <= self.count as f32).then(|| (at as usize).min(self.count - 1))
    }
}

/// Sums of a rectangle of pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    pub x0: u32,
    pub y0: u32,
    pub width: u32,
    pub height: u32,
    band_index: BandIndex,
    observer: Observer,
    /// `[pixel][band]`: weighted estimate, weight.
    sums: Vec<[f32; 2]>,
    /// `[pixel][band]`: weighted S1, S2, S3; empty for films without polarisation.
    stokes: Vec<[f32; 3]>,
    xyz: Vec<[f64; 3]>,
    samples: Vec<u32>,
    /// Sums of the filter's weights.
    weights: Vec<f64>,
    luminance: Vec<LuminanceMoments>,
    rejected: u64,
}

impl Tile {
    fn new([x0, y0, width, height]: [u32; 4], bands: Bands, polarised: bool) -> Tile {
        let pixels = (width * height) as usize;
        Tile {
            x0,
            y0,
            width,
            height,
            band_index: BandIndex::new(&bands),
            observer: bands.observer,
            sums: vec![[0.0; 2]; pixels * bands.count],
            stokes: vec![[0.0; 3]; if polarised { pixels * bands.count } else { 0 }],
            xyz: vec![[0.0; 3]; pixels],
            samples: vec![0; pixels],
            weights: vec![0.0; pixels],
            luminance: vec![LuminanceMoments::default(); pixels],
            rejected: 0,
        }
    }

    /// Adds a path's radiance to a pixel given by its position in the tile. `weight` is the filter's, with mean 1.
    #[inline]
    pub fn add<S: Stokes>(&mut self, x: u32, y: u32, wavelengths: &SampledWavelengths, light: &S, weight: f64) {
        let radiance = light.intensity();
        let polarisation = light.polarisation().filter(|_| !self.stokes.is_empty() && radiance.is_valid());
        let radiance = if radiance.is_valid() {
            radiance
        } else {
            self.rejected += 1;
            radiance.map(|r| if (0.0..f32::INFINITY).contains(&r) { r } else { 0.0 })
        };
        let pixel = (y * self.width + x) as usize;
        let row = pixel * self.band_index.count;
        let inverse_pdf = 1.0 / wavelengths.pdf;
        let estimates = (radiance.0 * inverse_pdf * weight as f32).to_array();
        let (lambda, knots) = (wavelengths.lambda_nm.to_array(), wavelengths.knots());
        let inverse_pdf_lanes = inverse_pdf;
        let inverse_pdf = inverse_pdf.to_array();
        let matching = self.observer.matching_functions();
        let mut luminance = 0.0;
        for i in 0..4 {
            if let Some(band) = self.band_index.of(lambda[i]) {
                let [sum, sum_of_weights] = &mut self.sums[row + band];
                *sum += estimates[i];
                *sum_of_weights += inverse_pdf[i];
            }
            let [x, y, z] = matching[knots[i]];
            let estimate = f64::from(estimates[i]);
            let total = &mut self.xyz[pixel];
            *total = [total[0] + x * estimate, total[1] + y * estimate, total[2] + z * estimate];
            luminance += y * estimate;
        }
        self.luminance[pixel].add(luminance, weight);
        self.weights[pixel] += weight;
        self.samples[pixel] += 1;
        if let Some(polarisation) = polarisation {
            let [s1, s2, s3] = polarisation.map(|s| (s.0 * inverse_pdf_lanes * weight as f32).to_array());
            for i in 0..4 {
                if let Some(band) = self.band_index.of(lambda[i]) {
                    let sum = &mut self.stokes[row + band];
                    *sum = [sum[0] + s1[i], sum[1] + s2[i], sum[2] + s3[i]];
                }
            }
        }
    }

    /// Mean Stokes parameters of a pixel's bands.
    fn fill_stokes(&self, pixel: usize, bands: &mut [[f32; 3]]) {
        let n = bands.len();
        let row = pixel * n..(pixel + 1) * n;
        let mut mean = vec![0.0; n];
        for parameter in 0..3 {
            let sums = row.clone().map(|i| [self.stokes[i][parameter], self.sums[i][1]]);
            fill_bands(&sums.collect::<Vec<_>>(), &mut mean);
            bands.iter_mut().zip(&mean).for_each(|(band, mean)| band[parameter] = *mean);
        }
    }

    /// Adds samples of a range of numbers to all pixels; `sample` gives wavelengths, radiance and the filter's weight.
    pub(crate) fn for_each_sample(
        &mut self,
        samples: std::ops::Range<u32>,
        sample: impl Fn([u32; 2], u32) -> (SampledWavelengths, SampledSpectrum, f64),
    ) {
        for y in 0..self.height {
            for x in 0..self.width {
                for index in samples.clone() {
                    let (wavelengths, radiance, weight) = sample([self.x0 + x, self.y0 + y], index);
                    self.add(x, y, &wavelengths, &radiance, weight);
                }
            }
        }
    }

    /// Pixels.
    pub fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// The luminance of the tile and the noise of its pixels; `None` while there are too few samples to tell.
    pub(crate) fn noise(&self) -> Option<TileNoise> {
        let mut tile = TileNoise::default();
        for (moments, samples) in self.luminance.iter().zip(&self.samples) {
            tile.add(moments, *samples)?;
        }
        Some(tile)
    }

    /// Samples of the pixel with the most.
    pub fn max_samples(&self) -> u32 {
        self.samples.iter().copied().max().unwrap_or(0)
    }
}

/// An image's sums.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    resolution: [u32; 2],
    bands: Bands,
    polarised: bool,
    pub(crate) tiles: Vec<Tile>,
}

/// Two films whose pixels or bands do not correspond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilmMismatch;

impl std::fmt::Display for FilmMismatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("films of different size, crop, bands or polarisation cannot be merged")
    }
}

impl std::error::Error for FilmMismatch {}

impl Film {
    /// An empty film of `resolution` pixels; only those of `crop` (x0, y0, x1, y1, end exclusive) take memory.
    pub fn new(resolution: [u32; 2], crop: Option<[u32; 4]>, bands: Bands, polarised: bool) -> Film {
        let [x0, y0, x1, y1] = crop.unwrap_or([0, 0, resolution[0], resolution[1]]);
        let (x1, y1) = (x1.min(resolution[0]), y1.min(resolution[1]));
        let columns = (x0..x1).step_by(TILE as usize);
        let tiles = (y0..y1)
            .step_by(TILE as usize)
            .flat_map(|y| columns.clone().map(move |x| (x, y)))
            .map(|(x, y)| Tile::new([x, y, TILE.min(x1 - x), TILE.min(y1 - y)], bands, polarised))
            .collect();
        Film { resolution, bands, polarised, tiles }
    }

    pub fn resolution(&self) -> [u32; 2] {
        self.resolution
    }

    /// Tiles in a row.
    pub(crate) fn columns(&self) -> usize {
        self.tiles.iter().take_while(|tile| tile.y0 == self.tiles[0].y0).count()
    }

    /// Relative noise of the picture ([`crate::noise`]): the median of its tiles; `None` with fewer than
    /// eight samples in some pixel, or without light that the observer sees.
    pub fn noise(&self) -> Option<f64> {
        NoiseMap::new(&self.tiles.iter().map(Tile::noise).collect::<Vec<_>>(), self.columns()).of_picture()
    }

    /// Bytes that a film of these pixels and its picture take, so that a caller can refuse what does not fit.
    pub fn bytes(resolution: [u32; 2], crop: Option<[u32; 4]>, bands: &Bands, polarised: bool) -> u64 {
        let area = |width: u32, height: u32| u64::from(width) * u64::from(height);
        let [x0, y0, x1, y1] = crop.unwrap_or([0, 0, resolution[0], resolution[1]]);
        let covered = area(x1.min(resolution[0]).saturating_sub(x0), y1.min(resolution[1]).saturating_sub(y0));
        let n = bands.count as u64;
        let stokes = if polarised { n * 12 } else { 0 };
        let (sums, picture) = (n * 8 + 24 + 4 + 8 + 56 + stokes, n * 4 + 12 + 8 + stokes);
        covered.saturating_mul(sums).saturating_add(area(resolution[0], resolution[1]).saturating_mul(picture))
    }

    /// Adds the sums of a film of other samples.
    pub fn merge(&mut self, other: &Film) -> Result<(), FilmMismatch> {
        let place = |t: &Tile| (t.x0, t.y0, t.width, t.height);
        let kind = |film: &Film| (film.resolution, film.polarised);
        let same = kind(self) == kind(other) && self.bands == other.bands;
        if !same || !self.tiles.iter().map(place).eq(other.tiles.iter().map(place)) {
            return Err(FilmMismatch);
        }
        for (tile, more) in self.tiles.iter_mut().zip(&other.tiles) {
            for (sum, more) in tile.sums.iter_mut().zip(&more.sums) {
                *sum = [sum[0] + more[0], sum[1] + more[1]];
            }
            for (sum, more) in tile.stokes.iter_mut().zip(&more.stokes) {
                *sum = [sum[0] + more[0], sum[1] + more[1], sum[2] + more[2]];
            }
            for (xyz, more) in tile.xyz.iter_mut().zip(&more.xyz) {
                *xyz = [xyz[0] + more[0], xyz[1] + more[1], xyz[2] + more[2]];
            }
            for (samples, more) in tile.samples.iter_mut().zip(&more.samples) {
                *samples += more;
            }
            for (weights, more) in tile.weights.iter_mut().zip(&more.weights) {
                *weights += more;
            }
            for (moments, more) in tile.luminance.iter_mut().zip(&more.luminance) {
                moments.merge(more);
            }
            tile.rejected += more.rejected;
        }
        Ok(())
    }

    /// Samples that were not finite or negative and were left out.
    pub fn rejected(&self) -> u64 {
        self.tiles.iter().map(|tile| tile.rejected).sum()
    }

    /// Camera paths so far.
    pub fn paths(&self) -> u64 {
        self.tiles.iter().flat_map(|tile| &tile.samples).map(|n| u64::from(*n)).sum()
    }

    /// Smallest and largest number of samples of the pixels that the film covers.
    pub fn samples_per_pixel(&self) -> (u32, u32) {
        let counts = || self.tiles.iter().flat_map(|tile| tile.samples.iter().copied());
        (counts().min().unwrap_or(0), counts().max().unwrap_or(0))
    }

    /// The picture, with the number of samples and the variance of the luminance as channels `samples.N` and `variance.Y`
    /// ([`crate::noise`]; the latter only where all covered pixels have eight samples at least). Pixels without samples
    /// are black. A band that no sample has hit yet, as happens below some
    /// sixteen samples, is interpolated linearly between its neighbours.
    pub fn to_image(&self) -> SpectralImage {
        let (width, height) = (self.resolution[0] as usize, self.resolution[1] as usize);
        let n = self.bands.count;
        let mut radiance = vec![0.0; width * height * n];
        let mut stokes = if self.polarised { vec![[0.0; 3]; width * height * n] } else { Vec::new() };
        let mut xyz = vec![[0.0; 3]; width * height];
        let mut samples = vec![0.0; width * height];
        let mut variance = vec![Some(0.0); width * height];
        for tile in &self.tiles {
            for pixel in 0..tile.samples.len() {
                let (x, y) = (pixel % tile.width as usize, pixel / tile.width as usize);
                let at = (tile.y0 as usize + y) * width + tile.x0 as usize + x;
                let bands = at * n..(at + 1) * n;
                fill_bands(&tile.sums[pixel * n..(pixel + 1) * n], &mut radiance[bands.clone()]);
                if self.polarised {
                    tile.fill_stokes(pixel, &mut stokes[bands.clone()]);
                }
                let count = f64::from(tile.samples[pixel]);
                let weight = limited_weight(tile.weights[pixel], tile.samples[pixel].max(1));
                // One, but for filters with negative lobes.
                let per_weight = (count / weight) as f32;
                radiance[bands.clone()].iter_mut().for_each(|r| *r *= per_weight);
                stokes.get_mut(bands).into_iter().flatten().for_each(|s| *s = s.map(|s| s * per_weight));
                let k = 0.25 * LUMINOUS_EFFICACY / weight;
                xyz[at] = tile.xyz[pixel].map(|sum| (sum * k) as f32);
                samples[at] = tile.samples[pixel] as f32;
                variance[at] = tile.luminance[pixel].variance_of_mean(tile.samples[pixel]).map(|v| v as f32);
            }
        }
        let stokes = self.polarised.then_some(stokes);
        let band_edges_nm = self.bands.edges_nm();
        SpectralImage {
            width,
            height,
            band_edges_nm,
            radiance,
            stokes,
            xyz,
            channels: statistics(samples, variance),
            metadata: Vec::new(),
        }
    }
}

/// The statistics of pixels as channels; an unknown variance leaves out that channel.
fn statistics(samples: Vec<f32>, variance: Vec<Option<f32>>) -> Vec<Channel> {
    let mut channels = vec![Channel { name: "samples.N".into(), samples }];
    if let Some(samples) = variance.into_iter().collect() {
        channels.push(Channel { name: "variance.Y".into(), samples });
    }
    channels
}

/// Ratios of the sums; empty bands between filled ones are interpolated, at the ends repeated. All zero without any.
fn fill_bands(sums: &[[f32; 2]], radiance: &mut [f32]) {
    radiance.fill(0.0);
    let value = |i: usize| sums[i][0] / sums[i][1];
    let mut last: Option<usize> = None;
    for i in (0..sums.len()).filter(|i| sums[*i][1] > 0.0) {
        radiance[i] = value(i);
        match last {
            None => radiance[..i].fill(value(i)),
            Some(last) => {
                let slope = (value(i) - value(last)) / (i - last) as f32;
                let gap = radiance[last + 1..i].iter_mut().enumerate();
                gap.for_each(|(k, r)| *r = value(last) + slope * (k + 1) as f32);
            }
        }
        last = Some(i);
    }
    if let Some(last) = last {
        radiance[last + 1..].fill(value(last));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn constant_film(resolution: [u32; 2], samples: u32, value: f32) -> Film {
        let mut film = Film::new(resolution, None, Bands::default(), false);
        for tile in &mut film.tiles {
            for i in 0..samples {
                let wavelengths = SampledWavelengths::sample((f64::from(i) + 0.5) / f64::from(samples) * 0.25);
                tile.add(0, 0, &wavelengths, &SampledSpectrum::splat(value), 1.0);
            }
        }
        film
    }

    /// A constant spectrum is exact in every band, however few the samples; Y is 683 times the integral of y.
    #[test]
    fn constant_spectra_are_exact() {
        for samples in [1, 4, 256] {
            let image = constant_film([1, 1], samples, 2.0).to_image();
            assert_eq!(image.band_edges_nm.len(), 48);
            assert!(image.radiance.iter().all(|r| (r - 2.0).abs() < 1e-5), "{samples} samples: {:?}", image.radiance);
            if samples == 256 {
                let expected = 2.0 * 683.0 * 106.8569;
                assert!((f64::from(image.xyz[0][1]) / expected - 1.0).abs() < 1e-3, "{}", image.xyz[0][1]);
            }
        }
    }

    /// Bands cover the range that was asked for, whatever their width.
    #[test]
    fn bands_cover_their_range() {
        let over = |range: &WavelengthRange, width_nm| Bands::over(range, width_nm, Observer::Cie1931);
        for (min, max, width, count) in [(360.0, 830.0, 10.0, 47), (380.0, 700.0, 40.0, 8), (300.0, 777.0, 10.0, 48)] {
            let bands = over(&WavelengthRange::new(min, max).unwrap(), width);
            let edges = bands.edges_nm();
            assert_eq!((bands.count, edges[0]), (count, min));
            assert!((edges[count] - max).abs() < 1e-9, "{edges:?}");
        }
        assert_eq!(over(&WavelengthRange::VISIBLE, 1e9).count, 1);
        assert_eq!(over(&WavelengthRange::VISIBLE, 1e-9).count, MAX_BANDS);
    }

    /// Every observer sees the constant spectrum with the integrals of its matching functions.
    #[test]
    fn observers_have_their_own_eyes() {
        for observer in Observer::ALL {
            let bands = Bands::over(&WavelengthRange::VISIBLE, 10.0, observer);
            let mut film = Film::new([1, 1], None, bands, false);
            for i in 0..256 {
                let wavelengths = SampledWavelengths::sample((f64::from(i) + 0.5) / 1024.0);
                film.tiles[0].add(0, 0, &wavelengths, &SampledSpectrum::ONE, 1.0);
            }
            let expected = observer.xyz_of_radiance(&arsc_spectral::Spectrum::Constant(1.0));
            for (got, expected) in film.to_image().xyz[0].into_iter().zip(expected) {
                assert!((f64::from(got) / expected - 1.0).abs() < 4e-3, "{observer:?}: {got} instead of {expected}");
            }
        }
    }

    /// Weights of filters with negative lobes cancel out of a constant picture.
    #[test]
    fn signed_weights_leave_constants_alone() {
        let mut film = Film::new([1, 1], None, Bands::default(), false);
        for i in 0..256 {
            let wavelengths = SampledWavelengths::sample((f64::from(i) + 0.5) / 1024.0);
            film.tiles[0].add(0, 0, &wavelengths, &SampledSpectrum::ONE, if i % 8 == 3 { -1.3 } else { 1.5 });
        }
        let (got, exact) = (film.to_image().xyz[0], constant_film([1, 1], 256, 1.0).to_image().xyz[0]);
        // The wavelengths of a weight are not quite spread as all are.
        assert!((got[1] / exact[1] - 1.0).abs() < 0.02, "{got:?} instead of {exact:?}");
    }

    #[test]
    fn merging_is_adding() {
        let mut a = constant_film([1, 1], 8, 1.0);
        a.merge(&constant_film([1, 1], 8, 3.0)).unwrap();
        assert_eq!(a.paths(), 16);
        assert!(a.to_image().radiance.iter().all(|r| (r - 2.0).abs() < 1e-5));
        assert_eq!(a.merge(&constant_film([2, 1], 8, 3.0)), Err(FilmMismatch));
    }

    #[test]
    fn nonsense_is_counted_and_left_out() {
        let mut film = Film::new([1, 1], None, Bands::default(), false);
        for bad in [f32::NAN, f32::INFINITY, -1.0] {
            film.tiles[0].add(0, 0, &SampledWavelengths::sample(0.3), &SampledSpectrum::splat(bad), 1.0);
        }
        assert_eq!(film.rejected(), 3);
        assert!(film.to_image().radiance.iter().all(|r| *r == 0.0));
        assert_eq!(film.to_image().xyz, [[0.0; 3]]);
    }

    #[test]
    fn crops_cover_their_pixels_and_no_others() {
        let mut film = Film::new([40, 30], Some([5, 7, 39, 25]), Bands::default(), false);
        for tile in &mut film.tiles {
            let (width, height) = (tile.width, tile.height);
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                tile.add(x, y, &SampledWavelengths::sample(0.1), &SampledSpectrum::ONE, 1.0);
            }
        }
        let image = film.to_image();
        for (i, pixel) in image.radiance.chunks(47).enumerate() {
            let inside = (5..39).contains(&(i % 40)) && (7..25).contains(&(i / 40));
            assert_eq!(pixel[20] > 0.0, inside, "pixel {i}");
        }
        assert_eq!(film.samples_per_pixel(), (1, 1));
        assert_eq!(Film::new([4, 4], Some([9, 9, 2, 2]), Bands::default(), false).paths(), 0);
        assert_eq!(Film::bytes([40, 30], Some([5, 7, 39, 25]), &Bands::default(), false), 34 * 18 * 468 + 1200 * 208);
        assert_eq!(Film::bytes([4, 4], Some([9, 9, 2, 2]), &Bands::default(), false), 16 * 208);
    }
}
