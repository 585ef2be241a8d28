//! Luminous intensity by direction, and the files of lamp makers that hold it: IES LM-63 of 1986, 1995, 2002 and 2019, type C.
//!
//! Angles in degrees as in such files: the vertical one from nadir (0, straight down) to zenith (180), the horizontal one
//! about the vertical. Intensity in candela is bilinear in the two angles; directions above the last or below the first vertical
//! angle are dark. Symmetric lamps state part of the horizontal circle (one angle, or 0 to 90, or 0 to 180); the
//! rest is mirrored when the table is made, so that a web always spans the whole circle.
//!
//! Files: candela are multiplied by the file's multiplier and ballast factor, and before LM-63-2002 by the ballast-lamp factor. `TILT=INCLUDE`
//! gives the factor for an upright lamp; tilts in further files, and types A and B, are refused.

use std::fmt;

/// A table of candela over the sphere.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotometricWeb {
    /// Degrees, strictly increasing, within 0 to 180; at least two.
    vertical: Vec<f64>,
    /// Degrees, strictly increasing from 0 to 360; at least two, and the last row equals the first.
    horizontal: Vec<f64>,
    /// `[horizontal][vertical]`, finite and not negative.
    candela: Vec<f64>,
}

/// Why a text or a table is no photometric web.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WebError(String);

impl fmt::Display for WebError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for WebError {}

fn error<T>(message: impl Into<String>) -> Result<T, WebError> {
    Err(WebError(message.into()))
}

/// Values of a table at most: a reading every half degree over the whole sphere fits.
const MOST_VALUES: usize = 1 << 20;

impl PhotometricWeb {
    /// A table over the whole circle; see the fields of the type for what is asked of the arguments.
    ///
    /// # Errors
    /// What does not fit.
    pub fn new(vertical: Vec<f64>, horizontal: Vec<f64>, candela: Vec<f64>) -> Result<PhotometricWeb, WebError> {
        let increases = |angles: &[f64]| angles.windows(2).all(|pair| pair[0] < pair[1]);
        if vertical.len() < 2 || !increases(&vertical) || vertical[0] < 0.0 || vertical[vertical.len() - 1] > 180.0 {
            return error("the vertical angles do not increase within 0 to 180 degrees");
        }
        let whole = horizontal.first() == Some(&0.0) && horizontal.last() == Some(&360.0);
        if horizontal.len() < 2 || !increases(&horizontal) || !whole {
            return error("the horizontal angles do not increase from 0 to 360 degrees");
        }
        if vertical.len().checked_mul(horizontal.len()) != Some(candela.len()) {
            return error("there are not as many candela as pairs of angles");
        }
        if !candela.iter().all(|value| *value >= 0.0 && value.is_finite()) {
            return error("a candela value is negative or not finite");
        }
        Ok(PhotometricWeb { vertical, horizontal, candela })
    }

    pub fn vertical(&self) -> &[f64] {
        &self.vertical
    }

    pub fn horizontal(&self) -> &[f64] {
        &self.horizontal
    }

    pub fn candela(&self) -> &[f64] {
        &self.candela
    }

    /// Candela in a direction given by the cosine of the angle from nadir and the angle about the vertical, radians.
    pub fn intensity(&self, cos_nadir: f64, turn: f64) -> f64 {
        let vertical = cos_nadir.clamp(-1.0, 1.0).acos().to_degrees();
        let last = self.vertical.len() - 1;
        if vertical < self.vertical[0] || vertical > self.vertical[last] {
            return 0.0;
        }
        let horizontal = turn.to_degrees().rem_euclid(360.0);
        let (v, v_part) = cell(&self.vertical, vertical);
        let (h, h_part) = cell(&self.horizontal, horizontal);
        let along = |h: usize| {
            let row = &self.candela[h * self.vertical.len()..];
            row[v] + (row[v + 1] - row[v]) * v_part
        };
        along(h) * (1.0 - h_part) + along(h + 1) * h_part
    }

    /// Every intensity times a factor.
    ///
    /// # Errors
    /// A product that is negative or not finite.
    pub fn scaled(self, factor: f64) -> Result<PhotometricWeb, WebError> {
        let candela = self.candela.into_iter().map(|value| value * factor).collect();
        PhotometricWeb::new(self.vertical, self.horizontal, candela)
    }

    /// Luminous flux in lumen: the integral of the bilinear table, in closed form.
    pub fn lumens(&self) -> f64 {
        let n = self.vertical.len();
        let mut sum = 0.0;
        for (h, turns) in self.horizontal.windows(2).enumerate() {
            let mean = |v: usize| 0.5 * (self.candela[h * n + v] + self.candela[(h + 1) * n + v]);
            for (v, angles) in self.vertical.windows(2).enumerate() {
                let [a, b] = [angles[0], angles[1]].map(f64::to_radians);
                let slope = (mean(v + 1) - mean(v)) / (b - a);
                // Integral of (c + slope (x - a)) sin x from a to b.
                let zone = mean(v) * a.cos() - mean(v + 1) * b.cos() + slope * (b.sin() - a.sin());
                sum += zone * (turns[1] - turns[0]).to_radians();
            }
        }
        sum
    }

    /// The largest intensity, candela.
    pub fn peak(&self) -> f64 {
        self.candela.iter().copied().fold(0.0, f64::max)
    }

    /// From the text of an IES LM-63 file.
    ///
    /// # Errors
    /// What the text lacks, or has that is not understood.
    pub fn parse_ies(text: &str) -> Result<PhotometricWeb, WebError> {
        let (keywords, rest) = split_at_tilt(text)?;
        let mut numbers = Numbers(rest.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty()));
        let tilt = match keywords.tilt {
            "NONE" => 1.0,
            "INCLUDE" => numbers.upright_tilt()?,
            other => return error(format!("TILT={other} names another file")),
        };
        let [_lamps, _lumens, multiplier] = numbers.take::<3>()?;
        let [verticals, horizontals] = [numbers.count()?, numbers.count()?];
        let [kind, _units, _width, _length, _height, ballast, lamp, _watts] = numbers.take::<8>()?;
        if kind != 1.0 {
            return error("only photometry of type C is understood");
        }
        if verticals.saturating_mul(horizontals) > MOST_VALUES {
            return error(format!("the file claims {verticals} by {horizontals} values"));
        }
        let lamp = if keywords.has_lamp_factor { lamp } else { 1.0 };
        let factor = multiplier * ballast * lamp * tilt;
        let vertical = numbers.list(verticals)?;
        let horizontal = numbers.list(horizontals)?;
        let candela: Vec<f64> = numbers.list(verticals * horizontals)?.into_iter().map(|c| c * factor).collect();
        let (horizontal, candela) = whole_circle(&horizontal, candela, verticals)?;
        PhotometricWeb::new(vertical, horizontal, candela)
    }
}

/// Index of the cell of a point within increasing knots, and the position in it from 0 to 1.
fn cell(knots: &[f64], x: f64) -> (usize, f64) {
    let i = knots.partition_point(|knot| *knot <= x).clamp(1, knots.len() - 1) - 1;
    (i, ((x - knots[i]) / (knots[i + 1] - knots[i])).clamp(0.0, 1.0))
}

struct Keywords<'a> {
    tilt: &'a str,
    /// The number behind the ballast factor is one too; later it means something else.
    has_lamp_factor: bool,
}

/// What the lines up to `TILT=` say, and the numbers behind them.
fn split_at_tilt(text: &str) -> Result<(Keywords<'_>, &str), WebError> {
    let first = text.trim_start_matches('\u{feff}').lines().next().unwrap_or_default().trim();
    let has_lamp_factor = !(first.starts_with("IESNA:LM-63-2002") || first.starts_with("IES:LM-63-2019"));
    let mut offset = 0;
    for line in text.split_inclusive('\n') {
        offset += line.len();
        if let Some(tilt) = line.trim().strip_prefix("TILT=") {
            return Ok((Keywords { tilt: tilt.trim(), has_lamp_factor }, &text[offset..]));
        }
    }
    error("there is no line `TILT=`: this is no IES file")
}

struct Numbers<I>(I);

impl<'a, I: Iterator<Item = &'a str>> Numbers<I> {
    fn next(&mut self) -> Result<f64, WebError> {
        let Some(word) = self.0.next() else { return error("the file ends before all of its numbers") };
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => error(format!("`{}` is no number", word.chars().take(20).collect::<String>())),
        }
    }

    fn take<const N: usize>(&mut self) -> Result<[f64; N], WebError> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.next()?;
        }
        Ok(values)
    }

    fn count(&mut self) -> Result<usize, WebError> {
        let value = self.next()?;
        if value.fract() == 0.0 && (1.0..=MOST_VALUES as f64).contains(&value) {
            Ok(value as usize)
        } else {
            error(format!("{value} is no number of angles"))
        }
    }

    fn list(&mut self, count: usize) -> Result<Vec<f64>, WebError> {
        (0..count).map(|_| self.next()).collect()
    }

    /// The factor for an upright lamp of the tilt table that stands here.
    fn upright_tilt(&mut self) -> Result<f64, WebError> {
        self.next()?;
        let count = self.count()?;
        let (angles, factors) = (self.list(count)?, self.list(count)?);
        Ok(angles.iter().position(|angle| *angle == 0.0).map_or(1.0, |i| factors[i]))
    }
}

/// The rows of a lamp of any symmetry, over the whole circle.
fn whole_circle(horizontal: &[f64], candela: Vec<f64>, verticals: usize) -> Result<(Vec<f64>, Vec<f64>), WebError> {
    let rows: Vec<&[f64]> = candela.chunks_exact(verticals).collect();
    let (first, last) = (horizontal[0], horizontal[horizontal.len() - 1]);
    let mut table: Vec<(f64, &[f64])> = horizontal.iter().copied().zip(rows).collect();
    if let [(_, row)] = table[..] {
        table = vec![(0.0, row), (360.0, row)];
    } else {
        if (first, last) == (90.0, 270.0) {
            // Symmetric about the plane of 90 and 270 degrees.
            table.extend(mirrored(&table, 180.0));
            for (angle, _) in &mut table {
                *angle = angle.rem_euclid(360.0);
            }
            table.sort_by(|a, b| a.0.total_cmp(&b.0));
            table.dedup_by_key(|entry| entry.0);
            table.push((360.0, table[0].1));
        } else if first == 0.0 {
            if last == 90.0 {
                table.extend(mirrored(&table, 180.0));
            }
            if last == 90.0 || last == 180.0 {
                table.extend(mirrored(&table, 360.0));
            }
            // Some makers leave out the last row, which repeats the first.
            if last > 180.0 && last < 360.0 {
                table.push((360.0, table[0].1));
            }
        }
    }
    let angles = table.iter().map(|entry| entry.0).collect();
    Ok((angles, table.iter().flat_map(|entry| entry.1).copied().collect()))
}

/// The rows at `sum - angle`, ascending, without the one on the mirror.
fn mirrored<'a>(table: &[(f64, &'a [f64])], sum: f64) -> Vec<(f64, &'a [f64])> {
    table.iter().rev().filter(|entry| 2.0 * entry.0 != sum).map(|(angle, row)| (sum - angle, *row)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, tilt: &str, angles: [&[f64]; 2], candela: impl Fn(f64, f64) -> f64) -> String {
        let [vertical, horizontal] = angles;
        let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        let mut text =
            format!("{header}\n[MANUFAC] none\nTILT={tilt}\n1 1000 2.0 {} {} 1 2\n", vertical.len(), horizontal.len());
        text += &format!("0.1 0.1 0\n0.9 0.5 40\n{}\n{}\n", list(vertical), list(horizontal));
        for h in horizontal {
            text += &list(&vertical.iter().map(|v| candela(*v, *h)).collect::<Vec<_>>());
            text.push('\n');
        }
        text
    }

    /// Even light, a hemisphere that is linear in the angle, and the factors of two editions.
    #[test]
    fn lumens_are_the_closed_form() {
        let even = PhotometricWeb::parse_ies(&file("IESNA:LM-63-2002", "NONE", [&[0.0, 180.0], &[0.0]], |_, _| 100.0))
            .unwrap();
        assert!((even.lumens() - 4.0 * std::f64::consts::PI * 180.0).abs() < 1e-9);
        let old = PhotometricWeb::parse_ies(&file("IESNA:LM-63-1995", "NONE", [&[0.0, 180.0], &[0.0]], |_, _| 100.0))
            .unwrap();
        assert!((old.lumens() / even.lumens() - 0.5).abs() < 1e-12);
        let falling = PhotometricWeb::new(vec![0.0, 90.0], vec![0.0, 360.0], vec![1.0, 0.0, 1.0, 0.0]).unwrap();
        // 2 pi times the integral of (1 - 2 x / pi) sin x over 0 to pi / 2.
        let exact = std::f64::consts::TAU * (1.0 - 2.0 / std::f64::consts::PI);
        assert!((falling.lumens() - exact).abs() < 1e-12, "{}", falling.lumens());
        assert_eq!(falling.intensity(-0.1, 0.3), 0.0);
        assert!((falling.intensity((0.25 * std::f64::consts::PI).cos(), -7.0) - 0.5).abs() < 1e-12);
    }

    /// However much of the circle a file states, the web is the same.
    #[test]
    fn symmetric_files_are_mirrored() {
        let shape = |v: f64, h: f64| 100.0 + v + 10.0 * (2.0 * h.to_radians()).cos();
        let quarter: Vec<f64> = (0..=6).map(|i| 15.0 * f64::from(i)).collect();
        let half: Vec<f64> = (0..=12).map(|i| 15.0 * f64::from(i)).collect();
        let full: Vec<f64> = (0..=24).map(|i| 15.0 * f64::from(i)).collect();
        let side: Vec<f64> = (6..=18).map(|i| 15.0 * f64::from(i)).collect();
        let vertical = [0.0, 30.0, 90.0];
        let webs = [&quarter[..], &half, &full, &full[..24], &side]
            .map(|horizontal| PhotometricWeb::parse_ies(&file("", "NONE", [&vertical, horizontal], shape)).unwrap());
        for web in &webs {
            assert_eq!(web.horizontal().len(), 25);
            for turn in [0.0, 0.4, 1.9, 3.3, 4.8, 6.2] {
                let (a, b) = (web.intensity(0.9, turn), webs[2].intensity(0.9, turn));
                assert!((a - b).abs() < 1e-9, "{a} instead of {b} at {turn}");
            }
        }
    }

    #[test]
    fn tilt_tables_are_skipped_and_commas_allowed() {
        let text = file("", "INCLUDE", [&[0.0, 90.0], &[0.0]], |_, _| 10.0);
        let text = text.replace("TILT=INCLUDE\n", "TILT=INCLUDE\n1\n3\n0, 45, 90\n0.5, 0.8, 0.9\n");
        let web = PhotometricWeb::parse_ies(&text).unwrap();
        assert!((web.peak() - 10.0 * 2.0 * 0.9 * 0.5 * 0.5).abs() < 1e-12, "{}", web.peak());
    }

    /// Every beginning of a good file, and what makers and vandals write.
    #[test]
    fn bad_files_are_errors() {
        let good = file("IESNA:LM-63-2002", "NONE", [&[0.0, 45.0, 90.0], &[0.0, 90.0]], |v, h| v + h);
        assert!(PhotometricWeb::parse_ies(&good).is_ok());
        let end = good.trim_end().len();
        for cut in (0..end).filter(|cut| good[..*cut].split_whitespace().count() < good.split_whitespace().count()) {
            assert!(PhotometricWeb::parse_ies(&good[..cut]).is_err(), "cut at {cut}");
        }
        for (from, to) in
            [("NONE", "lamp.tlt"), (" 1 2\n", " 2 2\n"), ("45", "-45"), ("45", "nan"), (" 3 2 ", " 3 1e18 ")]
        {
            assert!(PhotometricWeb::parse_ies(&good.replacen(from, to, 1)).is_err(), "{to}");
        }
        assert!(PhotometricWeb::parse_ies("").is_err());
    }
}
