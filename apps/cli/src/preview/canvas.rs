//! A picture of sRGB bytes to draw on.

/// Rows of pixels, top first.
pub(crate) struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Canvas {
    /// One colour everywhere.
    pub(crate) fn filled(width: usize, height: usize, colour: [u8; 3]) -> Self {
        Self { width, height, pixels: vec![colour; width * height] }
    }

    pub(crate) fn width(&self) -> usize {
        self.width
    }
    pub(crate) fn height(&self) -> usize {
        self.height
    }

    /// All samples, three a pixel.
    pub(crate) fn samples(&self) -> &[u8] {
        self.pixels.as_flattened()
    }

    /// Mixes a colour into a pixel; nothing happens outside the picture.
    pub(crate) fn blend(&mut self, x: usize, y: usize, colour: [u8; 3], share: f32) {
        if x < self.width && y < self.height {
            let pixel = &mut self.pixels[y * self.width + x];
            let mix =
                |a: u8, b: u8| (f32::from(a) + (f32::from(b) - f32::from(a)) * share.clamp(0.0, 1.0)).round() as u8;
            *pixel = std::array::from_fn(|c| mix(pixel[c], colour[c]));
        }
    }

    /// Copies rows of `width` pixels to a place; what does not fit is cut.
    pub(crate) fn paste(&mut self, (x, y): (usize, usize), width: usize, pixels: &[[u8; 3]]) {
        let fitting = width.min(self.width.saturating_sub(x));
        for (row, source) in pixels.chunks(width).enumerate().take(self.height.saturating_sub(y)) {
            let start = (y + row) * self.width + x;
            self.pixels[start..start + fitting].copy_from_slice(&source[..fitting]);
        }
    }
}
