//! A sheet of SVG: pictures, and over them what `plotters` draws.

use std::collections::BTreeSet;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::{Rgb, RgbImage};
use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::Text;
use plotters::style::{IntoFont, RGBColor, TextStyle, WHITE};
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

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
    /// Whether it has areas of one colour, and 256 colours or fewer.
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
        let (kind, bytes) = if self.is_flat {
            let bytes = png_of_few_colors(self.picture);
            ("png", bytes.map_err(|error| error.to_string())?)
        } else {
            let mut bytes = Vec::new();
            let jpeg = JpegEncoder::new_with_quality(&mut bytes, 88).encode_image(self.picture);
            jpeg.map_err(|error| error.to_string())?;
            ("jpeg", bytes)
        };
        let data = STANDARD.encode(bytes);
        let (x, y) = fine(self.at);
        let [width, height] = [self.size.0, self.size.1].map(|side| side * FINE as u32);
        Ok(format!(
            r#"<image x="{x}" y="{y}" width="{width}" height="{height}" preserveAspectRatio="none" href="data:image/{kind};base64,{data}"/>"#
        ))
    }
}

/// A PNG with a palette.
fn png_of_few_colors(picture: &RgbImage) -> Result<Vec<u8>, EncodingError> {
    let colors: BTreeSet<[u8; 3]> = picture.pixels().map(|&Rgb(color)| color).collect();
    let colors: Vec<[u8; 3]> = colors.into_iter().collect();
    let index = |&Rgb(color): &Rgb<u8>| {
        let index = colors.binary_search(&color).expect("it was collected");
        u8::try_from(index).expect("256 colours or fewer")
    };
    let indices: Vec<u8> = picture.pixels().map(index).collect();
    let mut bytes = Vec::new();
    let (width, height) = picture.dimensions();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_palette(colors.concat());
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::NoFilter);
    encoder.write_header()?.write_image_data(&indices)?;
    Ok(bytes)
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
