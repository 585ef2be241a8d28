//! The body of binary PLY files, by hand: some ten times as fast as through ply-rs, whose elements are maps of names.
//!
//! Each element is a row of [`Field`]s, scalars and lists. A vertex row without lists has a fixed width; faces are read
//! field by field.

use std::io::Read;

use ply_rs::ply::{ElementDef, PropertyType, ScalarType};

use crate::MeshError;
use crate::ply::{Role, VertexRoles};

/// Bytes asked of the source at a time.
const CHUNK: usize = 1 << 18;
/// Lists longer than this are not believed.
const LONGEST_LIST: u64 = 1 << 28;

/// The source, a chunk at a time.
pub struct Bytes<'a> {
    source: &'a mut dyn Read,
    buffer: Vec<u8>,
    /// What is unread: `at..filled`.
    at: usize,
    filled: usize,
    big_endian: bool,
}

/// Why an element could not be read: the file ended, or failed.
#[derive(Debug)]
pub enum Broken {
    End,
    Io(std::io::Error),
    /// A list claims more than can be true.
    List(u64),
}

impl<'a> Bytes<'a> {
    pub fn new(source: &'a mut dyn Read, big_endian: bool) -> Bytes<'a> {
        Bytes { source, buffer: vec![0; CHUNK], at: 0, filled: 0, big_endian }
    }

    /// The next `count` bytes, `count` at most [`CHUNK`].
    #[inline]
    fn take(&mut self, count: usize) -> Result<&[u8], Broken> {
        if self.filled - self.at < count {
            self.refill(count)?;
        }
        self.at += count;
        Ok(&self.buffer[self.at - count..self.at])
    }

    #[cold]
    fn refill(&mut self, count: usize) -> Result<(), Broken> {
        self.buffer.copy_within(self.at..self.filled, 0);
        self.filled -= self.at;
        self.at = 0;
        while self.filled < count {
            match self.source.read(&mut self.buffer[self.filled..]) {
                Ok(0) => return Err(Broken::End),
                Ok(read) => self.filled += read,
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                Err(error) => return Err(Broken::Io(error)),
            }
        }
        Ok(())
    }

    #[inline]
    fn scalar(&mut self, scalar: &ScalarType) -> Result<Number, Broken> {
        let big_endian = self.big_endian;
        let bytes = self.take(width(scalar))?;
        Ok(Number::read(bytes, scalar, big_endian))
    }

    /// Passes over a list or scalar.
    fn skip(&mut self, property: &PropertyType) -> Result<(), Broken> {
        match property {
            PropertyType::Scalar(scalar) => self.take(width(scalar)).map(drop),
            PropertyType::List(count, item) => {
                let count = self.count(count)?;
                (0..count).try_for_each(|_| self.take(width(item)).map(drop))
            }
        }
    }

    fn count(&mut self, scalar: &ScalarType) -> Result<u64, Broken> {
        let count = self.scalar(scalar)?.integer();
        match u64::try_from(count) {
            Ok(count) if count <= LONGEST_LIST => Ok(count),
            _ => Err(Broken::List(count as u64)),
        }
    }
}

/// A number of any of the eight types.
#[derive(Clone, Copy)]
enum Number {
    Integer(i64),
    Float(f64),
}

impl Number {
    #[inline]
    fn read(bytes: &[u8], scalar: &ScalarType, big_endian: bool) -> Number {
        let mut word = [0u8; 8];
        let word = &mut word[..bytes.len()];
        word.copy_from_slice(bytes);
        if big_endian {
            word.reverse();
        }
        let bits = word.iter().rev().fold(0u64, |bits, &byte| bits << 8 | u64::from(byte));
        match scalar {
            ScalarType::Char => Number::Integer((bits as i8).into()),
            ScalarType::UChar | ScalarType::UShort | ScalarType::UInt => Number::Integer(bits as i64),
            ScalarType::Short => Number::Integer((bits as i16).into()),
            ScalarType::Int => Number::Integer((bits as i32).into()),
            ScalarType::Float => Number::Float(f32::from_bits(bits as u32).into()),
            ScalarType::Double => Number::Float(f64::from_bits(bits)),
        }
    }

    fn float(self) -> f64 {
        match self {
            Number::Integer(i) => i as f64,
            Number::Float(f) => f,
        }
    }

    fn integer(self) -> i64 {
        match self {
            Number::Integer(i) => i,
            Number::Float(f) => f as i64,
        }
    }
}

fn width(scalar: &ScalarType) -> usize {
    match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

/// Fewest bytes that a row of the element takes.
pub fn least_width(element: &ElementDef) -> u64 {
    let least = |property: &PropertyType| match property {
        PropertyType::Scalar(scalar) | PropertyType::List(scalar, _) => width(scalar) as u64,
    };
    element.properties.values().map(|property| least(&property.data_type)).sum()
}

/// Calls `take` with the values of each row, by [`Role`].
pub fn vertices(
    bytes: &mut Bytes<'_>,
    element: &ElementDef,
    roles: &VertexRoles,
    mut take: impl FnMut(&[f64; Role::COUNT]) -> Result<(), MeshError>,
) -> Result<(), MeshError> {
    let fields: Vec<(PropertyType, Option<Role>)> =
        element.properties.values().map(|p| (p.data_type.clone(), roles.get(&p.name))).collect();
    let mut values = [0.0; Role::COUNT];
    for row in 0..element.count {
        for (property, role) in &fields {
            let read = match (property, role) {
                (PropertyType::Scalar(scalar), Some(role)) => {
                    bytes.scalar(scalar).map(|number| values[*role as usize] = number.float())
                }
                (property, _) => bytes.skip(property),
            };
            read.map_err(|broken| explain(broken, element, row))?;
        }
        take(&values)?;
    }
    Ok(())
}

/// Calls `take` with the list of each row that is named one of `names`.
pub fn lists(
    bytes: &mut Bytes<'_>,
    element: &ElementDef,
    names: &[&str],
    mut take: impl FnMut(&[i64]) -> Result<(), MeshError>,
) -> Result<(), MeshError> {
    let fields: Vec<(PropertyType, bool)> =
        element.properties.values().map(|p| (p.data_type.clone(), names.contains(&p.name.as_str()))).collect();
    let mut list = Vec::new();
    for row in 0..element.count {
        list.clear();
        for (property, is_wanted) in &fields {
            let read = match property {
                PropertyType::List(count, item) if *is_wanted => read_list(bytes, count, item, &mut list),
                property => bytes.skip(property),
            };
            read.map_err(|broken| explain(broken, element, row))?;
        }
        take(&list)?;
    }
    Ok(())
}

/// Passes over all rows.
pub fn skip(bytes: &mut Bytes<'_>, element: &ElementDef) -> Result<(), MeshError> {
    lists(bytes, element, &[], |_| Ok(()))
}

#[inline]
fn read_list(bytes: &mut Bytes<'_>, count: &ScalarType, item: &ScalarType, list: &mut Vec<i64>) -> Result<(), Broken> {
    let count = bytes.count(count)?;
    let (width, big_endian) = (width(item), bytes.big_endian);
    if let (3, 4, false, ScalarType::Int | ScalarType::UInt) = (count, width, big_endian, item) {
        // Nearly all faces of nearly all files.
        let corners = bytes.take(12)?;
        list.extend(corners.chunks_exact(4).map(|c| Number::read(c, item, false).integer()));
        return Ok(());
    }
    for _ in 0..count {
        list.push(bytes.scalar(item)?.integer());
    }
    Ok(())
}

fn explain(broken: Broken, element: &ElementDef, row: usize) -> MeshError {
    let (element, index, count) = (element.name.clone(), row as u64 + 1, element.count as u64);
    match broken {
        Broken::End => MeshError::Truncated { element, index, count },
        Broken::Io(error) => MeshError::Read(error),
        Broken::List(items) => MeshError::List { element, index, items },
    }
}
