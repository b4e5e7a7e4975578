//! A drawn SVG as PNG.

use super::sheet::Drawing;
use anyhow::{Context, Result};
use resvg::tiny_skia::{Pixmap, PixmapPaint, Transform};
use resvg::usvg::{Options, Tree};

/// Pixels of the PNG for a pixel of the SVG: legible on displays of either kind.
pub(crate) const SCALE: f32 = 2.0;

/// The picture at twice its size, with the typeface that ships with the program.
///
/// resvg is built without its decoders of pictures: insets, whose pixels are those of the PNG, are put in here.
pub(crate) fn png(drawing: &Drawing) -> Result<Vec<u8>> {
    let mut options = Options { font_family: "Hack".to_owned(), ..Options::default() };
    let fonts = options.fontdb_mut();
    fonts.load_font_data(epaint_default_fonts::HACK_REGULAR.to_vec());
    fonts.set_monospace_family("Hack");
    let tree = Tree::from_str(&drawing.svg_without_insets(), &options).context("the drawn picture")?;
    let size = tree.size().to_int_size().scale_by(SCALE).context("the size of the picture")?;
    let mut pixels = Pixmap::new(size.width(), size.height()).context("the size of the picture")?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    for inset in &drawing.insets {
        let picture = Pixmap::decode_png(&inset.png).context("a picture inside the picture")?;
        let [x, y] = [inset.area[0], inset.area[1]].map(|c| (c as f32 * SCALE).round() as i32);
        pixels.draw_pixmap(x, y, picture.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
    }
    pixels.encode_png().context("the picture as PNG")
}
