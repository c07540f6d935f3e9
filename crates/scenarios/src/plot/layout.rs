//! Layout of charts: how large each is, where its points come to lie, how its legend is broken into lines.

use super::chart::{Chart, Sample};
use super::style::Style;

/// Sizes in px.
pub(super) const FONT: f64 = 13.0;
pub(super) const TITLE: f64 = 14.0;
/// Width of a letter as a share of its height: a mean of proportional fonts, on the safe side.
pub(super) const LETTER: f64 = 0.56;
pub(super) const LEFT: f64 = 62.0;
pub(super) const RIGHT: f64 = 16.0;
pub(super) const TOP: f64 = 32.0;
pub(super) const BOTTOM: f64 = 46.0;
pub(super) const LEGEND_LINE: f64 = 20.0;
pub(super) const SAMPLE: f64 = 28.0;
/// Height of a chart with free axes as a share of its width.
pub(super) const FLAT: f64 = 0.68;
/// A chart with equal axes is at most this many times as high as it is wide.
pub(super) const HIGHEST: f64 = 1.5;

/// Left edge of the legend.
pub(super) const LEGEND_INDENT: f64 = 14.0;

/// A chart with its scales.
pub(super) struct Placed<'a> {
    pub(super) chart: &'a Chart,
    pub(super) ranges: [[f64; 2]; 2],
    pub(super) size: [f64; 2],
    /// Entries of the legend by line.
    pub(super) legend: Vec<Vec<&'a (String, Style, Sample)>>,
}

impl<'a> Placed<'a> {
    pub(super) fn new(chart: &'a Chart, width: f64) -> Self {
        let mut ranges = chart.ranges();
        let [x, y] = ranges;
        let mut height = FLAT * width;
        if chart.equal {
            let wanted = width * (y[1] - y[0]) / (x[1] - x[0]);
            height = wanted.clamp(0.3 * width, HIGHEST * width);
            if wanted > height {
                widen(&mut ranges[0], (y[1] - y[0]) * width / height);
            } else if wanted < height {
                widen(&mut ranges[1], (x[1] - x[0]) * height / width);
            }
        }
        Self { chart, ranges, size: [width, height], legend: legend_lines(chart, LEFT + width) }
    }

    pub(super) fn whole_height(&self) -> f64 {
        TOP + self.size[1] + BOTTOM + LEGEND_LINE * self.legend.len() as f64 + 8.0
    }

    /// Place of a point in px from the plot's upper left corner.
    pub(super) fn place(&self, point: &[f64; 2]) -> [f64; 2] {
        let share = [0, 1].map(|axis| {
            let [low, high] = self.ranges[axis];
            (point[axis] - low) / (high - low)
        });
        [share[0] * self.size[0], (1.0 - share[1]) * self.size[1]]
    }
}

/// Makes a range `length` long, its middle kept.
fn widen(range: &mut [f64; 2], length: f64) {
    let more = 0.5 * (length - (range[1] - range[0]));
    *range = [range[0] - more, range[1] + more];
}

/// Width of an entry of the legend, px.
pub(super) fn entry_width(name: &str) -> f64 {
    SAMPLE + LETTER * FONT * name.chars().count() as f64 + 14.0
}

/// Entries in lines no wider than `width`.
fn legend_lines(chart: &Chart, width: f64) -> Vec<Vec<&(String, Style, Sample)>> {
    let mut lines: Vec<Vec<_>> = Vec::new();
    let mut used = f64::INFINITY;
    for entry in &chart.legend {
        let needed = entry_width(&entry.0);
        if used + needed > width - LEGEND_INDENT {
            lines.push(Vec::new());
            used = 0.0;
        }
        used += needed;
        if let Some(line) = lines.last_mut() {
            line.push(entry);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{BLACK, line};

    fn chart() -> Chart {
        let mut chart = Chart::map("a map", "x (cm)", "y (cm)");
        chart.limits([0.0, 2.0], [0.0, 1.0]);
        chart.line("first", line(BLACK, 1.0), vec![[0.0, 0.0], [2.0, 1.0]]);
        chart
    }

    #[test]
    fn a_unit_is_as_long_on_both_axes_of_a_map() {
        let chart = chart();
        let placed = Placed::new(&chart, 200.0);
        assert_eq!(placed.size, [200.0, 100.0]);
        assert_eq!(placed.place(&[1.0, 1.0]), [100.0, 0.0]);
        assert_eq!(placed.place(&[2.0, 0.0]), [200.0, 100.0]);
    }

    #[test]
    fn long_legends_go_on_in_the_next_line() {
        let mut chart = chart();
        for name in ["a name that is rather long", "another one that is long", "the third"] {
            chart.line(name, line(BLACK, 1.0), Vec::new());
        }
        let lines = legend_lines(&chart, 300.0);
        assert!(lines.len() > 1 && lines.iter().map(Vec::len).sum::<usize>() == 4);
    }
}
