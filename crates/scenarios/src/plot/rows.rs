//! A chart with a scale along x and a row for each thing that is compared: dots, boxes, intervals, bars.
//!
//! Drawn for a page: its colors are classes (`ink`, `faint`, `grid`, `limit`, `c0` to `c7`), so that the page's style sheet
//! decides about them, in light and in dark; title and description are in the markup for those who do not see it.

use std::fmt::Write as _;

use super::axis::{range, ticks};
use super::svg::escaped;

/// Sizes in px.
const WIDTH: f64 = 460.0;
const ROW: f64 = 46.0;
const TOP: f64 = 44.0;
const BOTTOM: f64 = 44.0;
const RIGHT: f64 = 18.0;
const LEAST_LEFT: f64 = 60.0;
const MOST_LEFT: f64 = 180.0;
const LETTER: f64 = 7.2;
const DOT: f64 = 2.6;
/// Dots give way to each other by at most this many lanes to either side.
const LANES: i32 = 4;
/// Number of colors.
const COLORS: usize = 8;
/// Values that differ by less than this share of their size lie at one place, for the eye.
const ONE_PLACE: f64 = 1e-5;
/// Room to either side of values at one place, as a share of their size, which counts as at least 1.
const ROOM: f64 = 0.5;
/// A limit is drawn if it lies no farther outside than this many times the range of the data.
const LIMIT_REACH: f64 = 0.6;

/// A mark in a row, in the unit of the scale.
#[derive(Clone, Debug, PartialEq)]
pub enum RowMark {
    /// A dot for each value.
    Dots(Vec<f64>),
    /// Least value, first and third quartile, greatest value.
    Box([f64; 4]),
    /// A value with its interval.
    Interval {
        /// The value.
        at: f64,
        /// Its interval, if there is one.
        interval: Option<[f64; 2]>,
    },
    /// A bar from zero.
    Bar(f64),
}

/// The chart.
#[derive(Clone, Debug, PartialEq)]
pub struct RowChart {
    title: String,
    label: String,
    description: String,
    /// What the scale shows; else that is what the marks need.
    pub range: Option<[f64; 2]>,
    rows: Vec<(String, usize, Vec<RowMark>)>,
    limit: Option<(f64, String)>,
    zero: bool,
}

impl RowChart {
    /// An empty chart; `label` is that of the scale, `description` says in words what the chart shows.
    pub fn new(title: &str, label: &str, description: String) -> Self {
        let (title, label) = (title.to_owned(), label.to_owned());
        Self { title, label, description, range: None, rows: Vec::new(), limit: None, zero: false }
    }

    /// Adds a row in the color of that number.
    pub fn row(&mut self, name: &str, color: usize, marks: Vec<RowMark>) {
        self.rows.push((name.to_owned(), color % COLORS, marks));
    }

    /// Whether there is a row with something in it.
    pub fn has_rows(&self) -> bool {
        self.rows.iter().any(|(_, _, marks)| !marks.is_empty())
    }

    /// Marks a limit.
    pub fn limit(&mut self, at: f64, words: &str) {
        self.limit = Some((at, words.to_owned()));
    }

    /// Marks zero.
    pub fn zero(&mut self) {
        self.zero = true;
    }

    /// Draws it; `id` is unique on the page.
    pub fn svg(&self, id: &str) -> String {
        let longest = self.rows.iter().map(|(name, ..)| name.chars().count()).max().unwrap_or(0);
        let left = (LETTER * longest as f64 + 18.0).clamp(LEAST_LEFT, MOST_LEFT);
        let height = ROW * self.rows.len() as f64;
        let scale = Scale { range: self.shown(), width: WIDTH };
        let (whole_width, whole_height) = (left + WIDTH + RIGHT, TOP + height + BOTTOM);
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {whole_width:.0} {whole_height:.0}\" \
             width=\"{whole_width:.0}\" height=\"{whole_height:.0}\" role=\"img\" aria-labelledby=\"{id}-t {id}-d\">\n\
             <title id=\"{id}-t\">{}</title><desc id=\"{id}-d\">{}</desc>\n\
             <g transform=\"translate({left:.1} {TOP:.1})\">\n",
            escaped(&format!("{}: {}", self.title, self.label)),
            escaped(&self.description)
        );
        self.axis(&mut out, &scale, height);
        for (index, row) in self.rows.iter().enumerate() {
            draw_row(&mut out, &scale, (index as f64 + 0.5) * ROW, row, left);
        }
        out.push_str("</g></svg>\n");
        out
    }

    /// The range of the scale: all marks, zero if it is marked, the limit if it is not far off.
    fn shown(&self) -> [f64; 2] {
        if let Some(range) = self.range {
            return range;
        }
        let values = || self.rows.iter().flat_map(|(_, _, marks)| marks).flat_map(RowMark::values);
        let [low, high] = range(values().chain(self.zero.then_some(0.0)));
        let middle = low.midpoint(high);
        if high - low <= ONE_PLACE * (1.0 + middle.abs()) {
            let room = ROOM * middle.abs().max(1.0);
            return [middle - room, middle + room];
        }
        let reach = LIMIT_REACH * (high - low);
        let near =
            self.limit.as_ref().map(|(limit, _)| *limit).filter(|limit| (low - reach..high + reach).contains(limit));
        range(values().chain(self.zero.then_some(0.0)).chain(near))
    }

    fn axis(&self, out: &mut String, scale: &Scale, height: f64) {
        let _ = writeln!(out, "<text class=\"ink strong\" x=\"0\" y=\"-27\">{}</text>", escaped(&self.title));
        let (values, decimals) = ticks(scale.range);
        for value in values {
            // no minus before a zero
            let value = if value == 0.0 { 0.0 } else { value };
            let x = scale.place(value);
            let label = format!("{value:.decimals$}").replace('-', "\u{2212}");
            let _ = writeln!(
                out,
                "<path class=\"grid\" d=\"M{x:.1} 0V{height:.1}\"/>\
                 <text class=\"faint\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
                height + 17.0
            );
        }
        let _ = writeln!(
            out,
            "<path class=\"axis\" d=\"M0 {height:.1}H{WIDTH:.1}\"/>\
             <text class=\"faint\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            0.5 * WIDTH,
            height + 36.0,
            escaped(&self.label)
        );
        if self.zero {
            let x = scale.place(0.0);
            let _ = writeln!(out, "<path class=\"axis\" d=\"M{x:.1} 0V{height:.1}\"/>");
        }
        self.draw_limit(out, scale, height);
    }

    /// The limit as a line with its words, or an arrow to where it lies beyond the scale.
    fn draw_limit(&self, out: &mut String, scale: &Scale, height: f64) {
        let Some((limit, words)) = &self.limit else { return };
        let [low, high] = scale.range;
        let words = escaped(words);
        let (x, anchor, words) = if *limit < low {
            (0.0, "start", format!("\u{2190} {words}"))
        } else if *limit > high {
            (WIDTH, "end", format!("{words} \u{2192}"))
        } else {
            let x = scale.place(*limit);
            let _ = writeln!(out, "<path class=\"limit\" d=\"M{x:.1} -2V{height:.1}\"/>");
            (x, if x > 0.5 * WIDTH { "end" } else { "start" }, words)
        };
        let _ =
            writeln!(out, "<text class=\"limit-text\" x=\"{x:.1}\" y=\"-6\" text-anchor=\"{anchor}\">{words}</text>");
    }
}

impl RowMark {
    fn values(&self) -> Vec<f64> {
        match self {
            Self::Dots(values) => values.clone(),
            Self::Box(values) => values.to_vec(),
            Self::Interval { at, interval } => interval.iter().flatten().copied().chain([*at]).collect(),
            Self::Bar(to) => vec![0.0, *to],
        }
    }
}

/// From values to px.
struct Scale {
    range: [f64; 2],
    width: f64,
}

impl Scale {
    fn place(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        (value - low) / (high - low) * self.width
    }
}

fn draw_row(out: &mut String, scale: &Scale, y: f64, row: &(String, usize, Vec<RowMark>), left: f64) {
    let (name, color, marks) = row;
    let _ = writeln!(out, "<g class=\"c{color}\">");
    let most = ((left - 18.0) / LETTER) as usize;
    let shown: String = if name.chars().count() > most {
        name.chars().take(most.saturating_sub(1)).chain(['\u{2026}']).collect()
    } else {
        name.clone()
    };
    let _ = writeln!(
        out,
        "<text class=\"ink\" x=\"-10\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
        y + 4.5,
        escaped(&shown)
    );
    if marks.is_empty() {
        let _ = writeln!(out, "<text class=\"faint\" x=\"8\" y=\"{:.1}\">no value</text>", y + 4.5);
    }
    marks.iter().for_each(|mark| draw_mark(out, scale, y, mark));
    out.push_str("</g>\n");
}

fn draw_mark(out: &mut String, scale: &Scale, y: f64, mark: &RowMark) {
    match mark {
        RowMark::Dots(values) => {
            out.push_str("<g class=\"dot\">");
            for [x, offset] in swarm(values.iter().map(|value| scale.place(*value)).collect()) {
                let _ = write!(out, "<circle cx=\"{x:.1}\" cy=\"{:.1}\" r=\"{DOT}\"/>", y + offset);
            }
            out.push_str("</g>\n");
        }
        RowMark::Box(values) => {
            let [least, first, third, greatest] = values.map(|value| scale.place(value));
            let _ = writeln!(
                out,
                "<path class=\"whisker\" d=\"M{least:.1} {y:.1}H{first:.1}M{third:.1} {y:.1}H{greatest:.1}\"/>\
                 <rect class=\"box\" x=\"{first:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"28\" rx=\"2\"/>",
                y - 14.0,
                third - first
            );
        }
        RowMark::Interval { at, interval } => {
            let x = scale.place(*at);
            if let Some([low, high]) = interval.map(|ends| ends.map(|end| scale.place(end))) {
                let (above, below) = (y - 5.0, y + 5.0);
                let _ = writeln!(
                    out,
                    "<path class=\"interval\" d=\"M{low:.1} {y:.1}H{high:.1}M{low:.1} {above:.1}V{below:.1}M{high:.1} {above:.1}V{below:.1}\"/>"
                );
            }
            let _ = writeln!(out, "<path class=\"middle\" d=\"M{x:.1} {:.1}l5 6l-5 6l-5 -6z\"/>", y - 6.0);
        }
        RowMark::Bar(to) => {
            let (from, to) = (scale.place(0.0), scale.place(*to));
            let _ = writeln!(
                out,
                "<rect class=\"bar\" x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"26\" rx=\"2\"/>",
                from.min(to),
                y - 13.0,
                (to - from).abs()
            );
        }
    }
}

/// Dots that give way to each other: places along the scale with the offsets from their row.
fn swarm(mut places: Vec<f64>) -> Vec<[f64; 2]> {
    places.sort_by(f64::total_cmp);
    let mut ends = [f64::NEG_INFINITY; 2 * LANES as usize + 1];
    let order = |lane: usize| if lane.is_multiple_of(2) { (lane / 2) as f64 } else { -(lane.div_ceil(2) as f64) };
    let put = |x: f64| {
        let free = ends.iter().position(|end| x - end >= 1.7 * DOT);
        // where all lanes are full, dots lie on each other: the emptiest takes it
        let emptiest = ends.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(lane, _)| lane);
        let lane = free.unwrap_or(emptiest);
        if let Some(end) = ends.get_mut(lane) {
            *end = x;
        }
        [x, 1.7 * DOT * order(lane)]
    };
    places.into_iter().map(put).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart() -> RowChart {
        let mut chart = RowChart::new("All & sundry", "error (mm)", "two rows".into());
        chart.row("a < b", 0, vec![RowMark::Dots(vec![1.0, 1.0, 2.0]), RowMark::Box([1.0, 1.0, 1.5, 2.0])]);
        chart.row("none", 9, vec![]);
        chart
    }

    #[test]
    fn words_cannot_break_the_markup_and_are_there_for_readers_by_ear() {
        let text = chart().svg("m0");
        for part in
            ["All &amp; sundry", "a &lt; b", "role=\"img\"", "<desc id=\"m0-d\">two rows</desc>", "no value", "c1"]
        {
            assert!(text.contains(part), "{part}\n{text}");
        }
        assert_eq!(text.matches("<g").count(), text.matches("</g>").count());
        assert!(!text.contains("NaN"));
    }

    #[test]
    fn a_limit_far_away_does_not_squeeze_the_data() {
        let mut chart = chart();
        chart.limit(100.0, "at most 100 mm");
        assert!(chart.shown()[1] < 3.0 && chart.svg("a").contains("at most 100 mm \u{2192}"));
        chart.limit(2.2, "at most 2.2 mm");
        assert!(chart.shown()[1] > 2.2 && chart.svg("a").contains(">at most 2.2 mm<"));
    }

    #[test]
    fn values_at_one_place_have_a_readable_scale() {
        let mut chart = RowChart::new("Contacts", "contacts", String::new());
        chart.row("a", 0, vec![RowMark::Dots(vec![0.0; 9])]);
        assert_eq!(chart.shown(), [-0.5, 0.5]);
        chart.row("b", 1, vec![RowMark::Dots(vec![1e-3])]);
        assert!(chart.shown()[1] < 1.1e-3, "values that differ are told apart");
    }

    #[test]
    fn dots_at_one_place_lie_beside_each_other() {
        let places = swarm(vec![5.0; 9]);
        let mut offsets: Vec<f64> = places.iter().map(|[_, offset]| *offset).collect();
        offsets.sort_by(f64::total_cmp);
        offsets.dedup();
        assert_eq!(offsets.len(), 9);
        assert_eq!(swarm(vec![0.0, 50.0]), [[0.0, 0.0], [50.0, 0.0]]);
    }
}
