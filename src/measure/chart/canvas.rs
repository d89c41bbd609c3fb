//! Draws lines, markers and text with `plotters`, in the same way for SVG and PNG.

use super::labels::PlotArea;
use plotters::coord::Shift;
use plotters::element::{PathElement, Polygon, Text};
use plotters::prelude::{
    BLACK, Color, DrawingArea, DrawingBackend, FontStyle, FontTransform, IntoFont, RGBColor, ShapeStyle,
};
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::fmt::Display;
use std::io;
use std::sync::LazyLock;

/// Colours of M. Okabe and K. Ito, "Color universal design" (2008), which people with colour vision deficiencies can
/// tell apart too.
pub const VERMILION: RGBColor = RGBColor(0xd5, 0x5e, 0x00);
pub const ORANGE: RGBColor = RGBColor(0xe6, 0x9f, 0x00);
pub const PURPLE: RGBColor = RGBColor(0xcc, 0x79, 0xa7);
pub const BLUE: RGBColor = RGBColor(0x00, 0x72, 0xb2);
pub const GREEN: RGBColor = RGBColor(0x00, 0x9e, 0x73);
pub const GREY: RGBColor = RGBColor(0x60, 0x60, 0x60);
pub const LIGHT: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);

/// The shape of a marker.
#[derive(Clone, Copy)]
pub enum Marker {
    Disc,
    Square,
    Diamond,
    Up,
    Down,
    Star,
}

/// The point of a text that lies at its position.
#[derive(Clone, Copy)]
pub enum Align {
    Left,
    Middle,
    Right,
}

/// The appearance of a text.
#[derive(Clone, Copy)]
pub struct Letters {
    pub size: f64,
    pub colour: RGBColor,
    pub is_bold: bool,
}

impl Letters {
    /// Black letters of normal weight, `size` pixels high.
    pub const fn new(size: f64) -> Self {
        Self { size, colour: BLACK, is_bold: false }
    }

    /// Estimates the width of a text.
    pub fn width(&self, text: &str) -> f64 {
        text.chars().count() as f64 * self.size * if self.is_bold { 0.62 } else { 0.55 }
    }

    /// Shortens a name in its middle, as its end may tell it from others, to at most this width in pixels.
    pub fn fit(&self, name: &str, width: f64) -> String {
        if self.width(name) <= width {
            return name.to_owned();
        }
        let count = name.chars().count();
        let kept = (width / self.width("n")) as usize / 2;
        let begin: String = name.chars().take(kept).collect();
        let end: String = name.chars().skip(count.saturating_sub(kept.saturating_sub(1))).collect();
        format!("{begin}…{end}")
    }

    /// Breaks a text into lines of at most this width.
    pub fn wrap(&self, text: &str, width: f64) -> Vec<String> {
        let mut lines = vec![String::new()];
        for word in text.split(' ') {
            let line = lines.last_mut().expect("one line");
            if line.is_empty() {
                line.push_str(word);
            } else if self.width(line) + self.width(word) + self.width(" ") <= width {
                line.push(' ');
                line.push_str(word);
            } else {
                lines.push(word.to_owned());
            }
        }
        lines
    }
}

/// Makes an error of a failed drawing operation; the errors of `plotters` may not live long enough to be kept.
fn failed(error: impl Display) -> io::Error {
    io::Error::other(error.to_string())
}

/// A drawing area.
pub struct Canvas<D: DrawingBackend> {
    area: DrawingArea<D, Shift>,
    /// Pixels per unit of the drawing.
    scale: f64,
}

impl<D: DrawingBackend> Canvas<D> {
    /// Makes a white canvas.
    pub fn new(area: DrawingArea<D, Shift>, scale: f64) -> io::Result<Self> {
        // The font of the PNG files. An SVG keeps text as text, which the viewer draws in a font of its own.
        static FONT: LazyLock<bool> = LazyLock::new(|| {
            register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular()).is_ok()
                && register_font("sans-serif", FontStyle::Bold, dejavu::sans::bold()).is_ok()
        });
        if !*FONT {
            return Err(io::Error::other("the font cannot be read"));
        }
        area.fill(&plotters::style::WHITE).map_err(failed)?;
        Ok(Self { area, scale })
    }

    /// Finishes the drawing.
    pub fn finish(self) -> io::Result<()> {
        self.area.present().map_err(failed)
    }

    fn pixel(&self, (x, y): (f64, f64)) -> (i32, i32) {
        ((x * self.scale).round() as i32, (y * self.scale).round() as i32)
    }

    /// Draws a line through points.
    pub fn line(&self, points: &[(f64, f64)], colour: RGBColor, width: f64) -> io::Result<()> {
        let points: Vec<_> = points.iter().map(|point| self.pixel(*point)).collect();
        let style = colour.stroke_width((width * self.scale).round().max(1.0) as u32);
        self.area.draw(&PathElement::new(points, style)).map_err(failed)
    }

    /// Draws the outline of a rectangle.
    pub fn frame(&self, area: PlotArea, colour: RGBColor) -> io::Result<()> {
        let PlotArea { left, top, right, bottom } = area;
        self.line(&[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)], colour, 1.0)
    }

    /// Draws a marker, filled or hollow.
    pub fn marker(
        &self,
        (x, y): (f64, f64),
        marker: Marker,
        colour: RGBColor,
        is_hollow: bool,
    ) -> io::Result<()> {
        let points = |corners: usize, turn: f64, radius: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
            let corner = |index: usize| {
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * (index as f64 / corners as f64 + turn));
                (x + radius(index) * sin, y - radius(index) * cos)
            };
            (0..=corners).map(|index| corner(index % corners)).collect()
        };
        let outline = match marker {
            Marker::Disc => points(24, 0.0, &|_| 5.0),
            Marker::Square => points(4, 0.125, &|_| 6.4),
            Marker::Diamond => points(4, 0.0, &|_| 6.8),
            Marker::Up => points(3, 0.0, &|_| 7.0),
            Marker::Down => points(3, 0.5, &|_| 7.0),
            Marker::Star => points(10, 0.0, &|index| if index % 2 == 0 { 10.0 } else { 4.4 }),
        };
        let fill = if is_hollow { plotters::style::WHITE } else { colour };
        let pixels: Vec<_> = outline.iter().map(|point| self.pixel(*point)).collect();
        let inside = ShapeStyle { color: fill.to_rgba(), filled: true, stroke_width: 0 };
        self.area.draw(&Polygon::new(pixels, inside)).map_err(failed)?;
        self.line(&outline, colour, 1.5)
    }

    /// Draws a line of text, vertically centred on its position.
    pub fn text(&self, text: &str, at: (f64, f64), align: Align, letters: Letters) -> io::Result<()> {
        self.write(text, at, align, letters, FontTransform::None)
    }

    /// Draws a text in lines of at most this width, left-aligned, and returns the height of the last line.
    pub fn paragraph(
        &self,
        text: &str,
        (x, y): (f64, f64),
        width: f64,
        line_height: f64,
        letters: Letters,
    ) -> io::Result<f64> {
        let mut last = y;
        for (index, line) in letters.wrap(text, width).iter().enumerate() {
            last = y + line_height * index as f64;
            self.text(line, (x, last), Align::Left, letters)?;
        }
        Ok(last)
    }

    /// Draws a line of text that runs upward.
    pub fn upward(&self, text: &str, at: (f64, f64), letters: Letters) -> io::Result<()> {
        self.write(text, at, Align::Middle, letters, FontTransform::Rotate270)
    }

    fn write(
        &self,
        text: &str,
        at: (f64, f64),
        align: Align,
        letters: Letters,
        turn: FontTransform,
    ) -> io::Result<()> {
        let style = if letters.is_bold { FontStyle::Bold } else { FontStyle::Normal };
        let across = match align {
            Align::Left => HPos::Left,
            Align::Middle => HPos::Center,
            Align::Right => HPos::Right,
        };
        let font = ("sans-serif", letters.size * self.scale, style).into_font().transform(turn);
        let style = font.color(&letters.colour).pos(Pos::new(across, VPos::Center));
        self.area.draw(&Text::new(text.to_owned(), self.pixel(at), style)).map_err(failed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_name_keeps_its_begin_and_its_end() {
        let letters = Letters::new(10.0);
        assert_eq!(letters.fit("short", 45.0), "short");
        let fitted = letters.fit("abcdefghij: grazing", 45.0);
        assert_eq!(fitted, "abcd…ing");
        assert!(letters.width(&fitted) <= 45.0);
    }
}
