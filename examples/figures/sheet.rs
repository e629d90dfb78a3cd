//! A sheet of SVG: pictures, and over them what `plotters` draws.

use std::io::Cursor;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, RgbImage};
use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::Text;
use plotters::style::{IntoFont, RGBColor, TextStyle, WHITE};

pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub type Outcome = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// `plotters` counts in whole pixels: so many are one on a sheet, that curves are smooth.
pub const FINE: i32 = 4;

pub const INK: RGBColor = RGBColor(40, 40, 40);

/// A picture on a sheet.
pub struct Placed<'a> {
    pub picture: &'a RgbImage,
    pub at: (i32, i32),
    pub size: (u32, u32),
    /// Whether it has areas of one colour, and not many colours.
    pub is_flat: bool,
}

/// The sheet of this size with `pictures` below what `draw` draws.
pub fn svg(
    size: (u32, u32),
    pictures: &[Placed],
    draw: impl FnOnce(&Area) -> Outcome,
) -> Result<String, String> {
    let mut text = String::new();
    let [width, height] = [size.0, size.1].map(|side| side * FINE as u32);
    let drawn = || -> Outcome {
        let area = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        area.fill(&WHITE)?;
        draw(&area)?;
        area.present()
    };
    drawn().map_err(|error| error.to_string())?;
    let whole = format!(r#"width="{width}" height="{height}" viewBox"#);
    let shown = format!(r#"width="{}" height="{}" viewBox"#, size.0, size.1);
    let mut text = text.replacen(&whole, &shown, 1);
    // After the white ground, which is drawn first.
    let ground = text.find("<rect").ok_or("a sheet has a ground")?;
    let end = text[ground..].find("/>").ok_or("a ground has an end")?;
    let images: Result<Vec<String>, String> = pictures.iter().map(Placed::element).collect();
    text.insert_str(ground + end + 2, &("\n".to_owned() + &images?.join("\n")));
    Ok(text)
}

impl Placed<'_> {
    fn element(&self) -> Result<String, String> {
        let mut bytes = Cursor::new(Vec::new());
        let (width, height) = self.picture.dimensions();
        let color = ExtendedColorType::Rgb8;
        let (kind, written) = if self.is_flat {
            let png = PngEncoder::new_with_quality(
                &mut bytes,
                CompressionType::Best,
                FilterType::NoFilter,
            );
            ("png", png.write_image(self.picture, width, height, color))
        } else {
            let jpeg = JpegEncoder::new_with_quality(&mut bytes, 88);
            ("jpeg", jpeg.write_image(self.picture, width, height, color))
        };
        written.map_err(|error| error.to_string())?;
        let data = STANDARD.encode(bytes.into_inner());
        let (x, y) = fine(self.at);
        let [width, height] = [self.size.0, self.size.1].map(|side| side * FINE as u32);
        Ok(format!(
            r#"<image x="{x}" y="{y}" width="{width}" height="{height}" preserveAspectRatio="none" href="data:image/{kind};base64,{data}"/>"#
        ))
    }
}

/// The place of a pixel of the sheet.
pub fn fine((x, y): (i32, i32)) -> (i32, i32) {
    (FINE * x, FINE * y)
}

/// Writes a line at its upper left corner.
pub fn write(area: &Area, line: impl Into<String>, at: (i32, i32), size: i32) -> Outcome {
    let style: TextStyle = ("sans-serif", FINE * size).into_font().color(&INK);
    area.draw(&Text::new(line.into(), fine(at), style))
}
