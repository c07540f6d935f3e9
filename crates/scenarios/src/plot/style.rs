//! Colors and strokes: told apart by color-blind readers, and in print without color by their dashes.

/// How a mark looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Color of lines, none for no line.
    pub stroke: Option<&'static str>,
    /// Width of lines, px.
    pub width: f64,
    /// Lengths of dashes and gaps, px; empty for a solid line.
    pub dashes: &'static str,
    /// Color of areas, none for no area.
    pub fill: Option<&'static str>,
    /// Opacity of the whole mark, 0 to 1.
    pub opacity: f64,
}

pub const BLACK: &str = "#1a1a1a";
pub const GRAY: &str = "#8c8c8c";
pub const LIGHT: &str = "#d9d9d9";
pub const BLUE: &str = "#0b5fa5";
pub const SKY: &str = "#56b4e9";
pub const RED: &str = "#c8321e";
pub const GREEN: &str = "#1b8a4b";
pub const ORANGE: &str = "#e08a00";
pub const PURPLE: &str = "#7b3fa0";

pub const DASHED: &str = "7 4";
pub const DOTTED: &str = "2 3";

/// A solid line, `width` in px.
pub const fn line(color: &'static str, width: f64) -> Style {
    Style { stroke: Some(color), width, dashes: "", fill: None, opacity: 1.0 }
}

/// An area without a border.
pub const fn fill(color: &'static str, opacity: f64) -> Style {
    Style { stroke: None, width: 0.0, dashes: "", fill: Some(color), opacity }
}

/// An area with a border.
pub const fn outlined(border: &'static str, area: &'static str, opacity: f64) -> Style {
    Style { stroke: Some(border), width: 1.2, dashes: "", fill: Some(area), opacity }
}

impl Style {
    /// The same with dashes.
    pub const fn dashed(self, dashes: &'static str) -> Self {
        Self { dashes, ..self }
    }

    /// The same, more or less transparent.
    pub const fn faint(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}
