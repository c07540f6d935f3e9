//! One chart: marks in the units of its axes, and what its legend says of them.

use super::axis;
use super::style::Style;

/// A mark in the units of the axes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mark {
    /// A line through points.
    Line(Vec<[f64; 2]>),
    /// Separate pieces of line.
    Pieces(Vec<[[f64; 2]; 2]>),
    /// A shape that is the union of convex polygons.
    Shape(Vec<Vec<[f64; 2]>>),
    /// Dots of a radius in px.
    Dots(Vec<[f64; 2]>, f64),
    /// A word at a place.
    Word([f64; 2], String),
}

/// A chart: a title, two axes, marks and a legend below them.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    pub(super) title: String,
    pub(super) labels: [String; 2],
    pub(super) limits: [Option<[f64; 2]>; 2],
    /// Whether a unit is as long on both axes.
    pub(super) equal: bool,
    pub(super) marks: Vec<(Mark, Style)>,
    pub(super) legend: Vec<(String, Style, Sample)>,
}

/// How the legend shows a mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sample {
    Line,
    Area,
    Dot(f64),
}

impl Chart {
    /// A chart whose axes are lengths on the table, equally scaled.
    pub fn map(title: impl Into<String>, x: &str, y: &str) -> Self {
        Self { equal: true, ..Self::graph(title, x, y) }
    }

    /// A chart whose axes have each its own scale.
    pub fn graph(title: impl Into<String>, x: &str, y: &str) -> Self {
        let labels = [x.to_owned(), y.to_owned()];
        Self { title: title.into(), labels, limits: [None; 2], equal: false, marks: Vec::new(), legend: Vec::new() }
    }

    /// Sets what the axes show; else that is what the marks need.
    pub fn limits(&mut self, x: [f64; 2], y: [f64; 2]) {
        self.limits = [Some(x), Some(y)];
    }

    /// Draws a line; `name` is for the legend, none for no entry.
    pub fn line<'a>(&mut self, name: impl Into<Option<&'a str>>, style: Style, points: Vec<[f64; 2]>) {
        self.enter(name.into(), style, Sample::Line);
        self.marks.push((Mark::Line(points), style));
    }

    /// Draws pieces of line that do not hang together.
    pub fn pieces<'a>(&mut self, name: impl Into<Option<&'a str>>, style: Style, pieces: Vec<[[f64; 2]; 2]>) {
        self.enter(name.into(), style, Sample::Line);
        self.marks.push((Mark::Pieces(pieces), style));
    }

    /// Draws a shape, the union of convex polygons, as one.
    pub fn shape<'a>(&mut self, name: impl Into<Option<&'a str>>, style: Style, polygons: Vec<Vec<[f64; 2]>>) {
        self.enter(name.into(), style, Sample::Area);
        self.marks.push((Mark::Shape(polygons), style));
    }

    /// Draws dots of a radius in px.
    pub fn dots<'a>(&mut self, name: impl Into<Option<&'a str>>, style: Style, radius: f64, points: Vec<[f64; 2]>) {
        self.enter(name.into(), style, Sample::Dot(radius));
        self.marks.push((Mark::Dots(points, radius), style));
    }

    /// Writes a word, centered at a place.
    pub fn word(&mut self, style: Style, place: [f64; 2], word: impl Into<String>) {
        self.marks.push((Mark::Word(place, word.into()), style));
    }

    fn enter(&mut self, name: Option<&str>, style: Style, sample: Sample) {
        let Some(name) = name else { return };
        if self.legend.iter().all(|(known, ..)| known != name) {
            self.legend.push((name.to_owned(), style, sample));
        }
    }

    /// What each axis shows.
    pub(super) fn ranges(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| {
            let values = self.marks.iter().flat_map(|(mark, _)| mark.points()).map(|point| point[axis]);
            self.limits[axis].unwrap_or_else(|| axis::range(values))
        })
    }
}

impl Mark {
    fn points(&self) -> Vec<[f64; 2]> {
        match self {
            Self::Line(points) | Self::Dots(points, _) => points.clone(),
            Self::Pieces(pieces) => pieces.iter().flatten().copied().collect(),
            Self::Shape(polygons) => polygons.iter().flatten().copied().collect(),
            Self::Word(place, _) => vec![*place],
        }
    }
}
