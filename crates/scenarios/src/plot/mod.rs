//! Charts as a paper prints them: axes with units, equal aspect where lengths are compared, a legend outside the data.
//!
//! Drawn straight to SVG, so that a figure needs no fonts, no display and no clock: equal data give equal bytes.

mod axis;
mod chart;
mod layout;
mod rows;
mod style;
mod svg;

pub use chart::Chart;
pub use rows::{RowChart, RowMark};
pub use style::{
    BLACK, BLUE, DASHED, DOTTED, GRAY, GREEN, LIGHT, ORANGE, PURPLE, RED, SKY, Style, fill, line, outlined,
};
pub use svg::{escaped, figure};
