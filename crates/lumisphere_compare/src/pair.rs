//! The two pictures.

use crate::error::CompareError;
use lumisphere_image::{Picture, Rgb};
use std::fmt;

/// One of the two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The picture that is judged.
    Test,
    /// The picture that it is held against.
    Reference,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Test => "test",
            Self::Reference => "reference",
        })
    }
}

/// A test and a reference picture of one size, at least one pixel, all channels finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair<'a> {
    width: usize,
    height: usize,
    test: &'a [Rgb],
    reference: &'a [Rgb],
}

impl<'a> Pair<'a> {
    /// Holds a picture against a reference.
    ///
    /// # Errors
    /// [`CompareError::Size`] for different sizes, [`CompareError::PixelCount`] for none, [`CompareError::NotFinite`].
    pub fn new(test: &'a Picture, reference: &'a Picture) -> Result<Self, CompareError> {
        let (width, height) = (reference.width, reference.height);
        check_size(test, width, height)?;
        check_count(test)?;
        check_count(reference)?;
        for (side, picture) in [(Side::Test, test), (Side::Reference, reference)] {
            check_finite(side, picture)?;
        }
        Ok(Self { width, height, test: &test.texels, reference: &reference.texels })
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }
    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }
    /// Pixels of the picture that is judged, top row first.
    pub fn test(&self) -> &'a [Rgb] {
        self.test
    }
    /// Pixels of the reference.
    pub fn reference(&self) -> &'a [Rgb] {
        self.reference
    }

    /// Test and reference of each channel of each pixel.
    pub(crate) fn values(&self) -> impl Iterator<Item = (f64, f64)> {
        let both = self.test.as_flattened().iter().zip(self.reference.as_flattened());
        both.map(|(a, b)| (f64::from(*a), f64::from(*b)))
    }
}

pub(crate) fn check_size(picture: &Picture, width: usize, height: usize) -> Result<(), CompareError> {
    if (picture.width, picture.height) == (width, height) {
        return Ok(());
    }
    Err(CompareError::Size { test_width: picture.width, test_height: picture.height, width, height })
}

pub(crate) fn check_count(picture: &Picture) -> Result<(), CompareError> {
    let (width, height, found) = (picture.width, picture.height, picture.texels.len());
    if found > 0 && width.checked_mul(height) == Some(found) {
        return Ok(());
    }
    Err(CompareError::PixelCount { width, height, found })
}

pub(crate) fn check_finite(side: Side, picture: &Picture) -> Result<(), CompareError> {
    match picture.texels.iter().filter(|t| t.iter().any(|c| !c.is_finite())).count() {
        0 => Ok(()),
        count => Err(CompareError::NotFinite { side, count }),
    }
}
