//! Charts to SVG: axes, marks, legends.

use std::fmt::Write as _;

use super::axis::ticks;
use super::chart::{Chart, Mark, Sample};
use super::layout::{BOTTOM, FONT, LEFT, LEGEND_INDENT, LEGEND_LINE, Placed, RIGHT, SAMPLE, TITLE, TOP, entry_width};
use super::style::{BLACK, Style};

/// Length of a tick, px.
const TICK: f64 = 5.0;

/// Draws charts side by side, `columns` in a row, the plot of each `width` px wide.
pub fn figure(charts: &[Chart], columns: usize, width: f64) -> String {
    let placed: Vec<Placed<'_>> = charts.iter().map(|chart| Placed::new(chart, width)).collect();
    let mut body = String::new();
    let (mut top, mut right) = (0.0, 0.0f64);
    for (row_index, row) in placed.chunks(columns.max(1)).enumerate() {
        let mut left = 0.0;
        for (column, chart) in row.iter().enumerate() {
            chart.draw(&mut body, [left, top], row_index * columns + column);
            left += LEFT + width + RIGHT;
        }
        right = right.max(left);
        top += row.iter().map(Placed::whole_height).fold(0.0, f64::max);
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{right:.0}\" height=\"{top:.0}\" viewBox=\"0 0 {right:.0} {top:.0}\" \
         font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"{FONT:.0}\">\n\
         <rect width=\"{right:.0}\" height=\"{top:.0}\" fill=\"#ffffff\"/>\n{body}</svg>\n"
    )
}

impl Placed<'_> {
    fn draw(&self, out: &mut String, at: [f64; 2], index: usize) {
        let [width, height] = self.size;
        let (left, top) = (at[0] + LEFT, at[1] + TOP);
        let _ = writeln!(out, "<g transform=\"translate({left:.1} {top:.1})\">");
        let _ = writeln!(
            out,
            "<clipPath id=\"plot{index}\"><rect width=\"{width:.1}\" height=\"{height:.1}\"/></clipPath>"
        );
        self.draw_grid(out);
        let _ = writeln!(out, "<g clip-path=\"url(#plot{index})\">");
        for (mark, style) in &self.chart.marks {
            self.draw_mark(out, mark, style);
        }
        out.push_str("</g>\n");
        let _ = writeln!(
            out,
            "<rect width=\"{width:.1}\" height=\"{height:.1}\" fill=\"none\" stroke=\"{BLACK}\" stroke-width=\"1\"/>"
        );
        self.draw_labels(out);
        self.draw_legend(out);
        out.push_str("</g>\n");
    }

    fn draw_grid(&self, out: &mut String) {
        let [width, height] = self.size;
        for (axis, range) in self.ranges.iter().enumerate() {
            let (values, decimals) = ticks(*range);
            for value in values {
                // no minus before a zero
                let value = if value == 0.0 { 0.0 } else { value };
                let [x, y] = self.place(&[value, value]);
                let label = format!("{value:.decimals$}").replace('-', "\u{2212}");
                let grid = "stroke=\"#ececec\" stroke-width=\"1\"";
                let tick = format!("stroke=\"{BLACK}\" stroke-width=\"1\"");
                let _ = if axis == 0 {
                    writeln!(
                        out,
                        "<path d=\"M{x:.1} 0V{height:.1}\" {grid}/><path d=\"M{x:.1} {height:.1}v{TICK}\" {tick}/>\
                         <text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"{BLACK}\">{label}</text>",
                        height + TICK + FONT
                    )
                } else {
                    writeln!(
                        out,
                        "<path d=\"M0 {y:.1}H{width:.1}\" {grid}/><path d=\"M0 {y:.1}h{:.0}\" {tick}/>\
                         <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"{BLACK}\">{label}</text>",
                        -TICK,
                        -TICK - 3.0,
                        y + 0.35 * FONT
                    )
                };
            }
        }
    }

    fn draw_labels(&self, out: &mut String) {
        let [width, height] = self.size;
        let [x, y] = &self.chart.labels;
        let _ = writeln!(
            out,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"{BLACK}\">{}</text>",
            width / 2.0,
            height + BOTTOM - 8.0,
            escaped(x)
        );
        let _ = writeln!(
            out,
            "<text transform=\"translate({:.1} {:.1}) rotate(-90)\" text-anchor=\"middle\" fill=\"{BLACK}\">{}</text>",
            14.0 - LEFT,
            height / 2.0,
            escaped(y)
        );
        let _ = writeln!(
            out,
            "<text x=\"0\" y=\"-11\" font-size=\"{TITLE:.0}\" font-weight=\"bold\" fill=\"{BLACK}\">{}</text>",
            escaped(&self.chart.title)
        );
    }

    fn draw_legend(&self, out: &mut String) {
        for (line, entries) in self.legend.iter().enumerate() {
            let y = self.size[1] + BOTTOM + LEGEND_LINE * (line as f64 + 0.5);
            let mut x = LEGEND_INDENT - LEFT;
            for (name, style, sample) in entries {
                let middle = y - 0.32 * FONT;
                let (from, to) = (x, x + SAMPLE - 6.0);
                let _ = match sample {
                    Sample::Line => {
                        writeln!(out, "<path d=\"M{from:.1} {middle:.1}H{to:.1}\" {}/>", attributes(style))
                    }
                    Sample::Area => writeln!(
                        out,
                        "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"14\" height=\"10\" {}/>",
                        from + 4.0,
                        middle - 5.0,
                        attributes(style)
                    ),
                    Sample::Dot(radius) => {
                        let at = 0.5 * (from + to);
                        writeln!(
                            out,
                            "<circle cx=\"{at:.1}\" cy=\"{middle:.1}\" r=\"{:.1}\" {}/>",
                            radius.max(2.5),
                            attributes(style)
                        )
                    }
                };
                let _ = writeln!(
                    out,
                    "<text x=\"{:.1}\" y=\"{y:.1}\" fill=\"{BLACK}\">{}</text>",
                    x + SAMPLE,
                    escaped(name)
                );
                x += entry_width(name);
            }
        }
    }

    fn draw_mark(&self, out: &mut String, mark: &Mark, style: &Style) {
        let _ = match mark {
            Mark::Line(points) => {
                writeln!(out, "<path d=\"{}\" {}/>", self.path(&thinned(points), false), attributes(style))
            }
            Mark::Pieces(pieces) => {
                let path: String = pieces.iter().map(|piece| self.path(piece, false)).collect();
                writeln!(out, "<path d=\"{path}\" {}/>", attributes(style))
            }
            Mark::Shape(polygons) => {
                // borders first, areas over them: what is inside the union is not seen
                let path: String = polygons.iter().map(|polygon| self.path(polygon, true)).collect();
                let Style { stroke, width, fill, opacity, dashes } = *style;
                let _ = writeln!(out, "<g opacity=\"{opacity}\">");
                if let Some(stroke) = stroke {
                    let border = Style { stroke: Some(stroke), width: 2.0 * width, dashes, fill: None, opacity: 1.0 };
                    let _ = writeln!(out, "<path d=\"{path}\" {}/>", attributes(&border));
                }
                let area = Style { stroke: None, width: 0.0, dashes: "", fill, opacity: 1.0 };
                writeln!(out, "<path d=\"{path}\" {}/></g>", attributes(&area))
            }
            Mark::Dots(points, radius) => {
                let _ = writeln!(out, "<g {}>", attributes(style));
                for point in points {
                    let [x, y] = self.place(point);
                    let _ = writeln!(out, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\"/>");
                }
                writeln!(out, "</g>")
            }
            Mark::Word(at, word) => {
                let [x, y] = self.place(at);
                let color = style.stroke.or(style.fill).unwrap_or(BLACK);
                let (y, word) = (y + 0.35 * FONT, escaped(word));
                // a white border below keeps the word legible on lines
                writeln!(
                    out,
                    "<g text-anchor=\"middle\" font-weight=\"bold\"><text x=\"{x:.1}\" y=\"{y:.1}\" fill=\"#ffffff\" \
                     stroke=\"#ffffff\" stroke-width=\"3\">{word}</text>\
                     <text x=\"{x:.1}\" y=\"{y:.1}\" fill=\"{color}\">{word}</text></g>"
                )
            }
        };
    }

    fn path(&self, points: &[[f64; 2]], closed: bool) -> String {
        let mut path = String::new();
        for (index, point) in points.iter().enumerate() {
            let [x, y] = self.place(point);
            let _ = write!(path, "{}{x:.1} {y:.1}", if index == 0 { "M" } else { "L" });
        }
        if closed {
            path.push('Z');
        }
        path
    }
}

/// More points than this are no better line.
const MOST_POINTS: usize = 400;

/// Evenly chosen points, both ends among them.
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let stride = points.len().div_ceil(MOST_POINTS).max(1);
    let mut few: Vec<[f64; 2]> = points.iter().step_by(stride).copied().collect();
    if !(points.len().max(1) - 1).is_multiple_of(stride) {
        few.extend(points.last());
    }
    few
}

fn attributes(style: &Style) -> String {
    let mut text = format!("fill=\"{}\"", style.fill.unwrap_or("none"));
    if let Some(stroke) = style.stroke {
        let _ = write!(text, " stroke=\"{stroke}\" stroke-width=\"{}\" stroke-linejoin=\"round\"", style.width);
    }
    if !style.dashes.is_empty() {
        let _ = write!(text, " stroke-dasharray=\"{}\"", style.dashes);
    }
    if style.opacity < 1.0 {
        let _ = write!(text, " opacity=\"{}\"", style.opacity);
    }
    text
}

/// A text that cannot break the markup around it.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::line;

    #[test]
    fn words_cannot_break_the_markup() {
        let mut chart = Chart::map("a < b", "x (cm)", "y (cm)");
        chart.line("first & only", line(BLACK, 1.0), vec![[0.0, 0.0], [2.0, 1.0]]);
        let text = figure(&[chart], 1, 200.0);
        assert!(text.contains("a &lt; b") && text.contains("first &amp; only"));
        assert_eq!(text.matches("<g").count(), text.matches("</g>").count());
    }

    #[test]
    fn thinning_keeps_both_ends() {
        let points: Vec<_> = (0..1001).map(|index| [f64::from(index), 0.0]).collect();
        let few = thinned(&points);
        assert!(few.len() <= MOST_POINTS + 1 && few[0] == points[0] && few.last() == points.last());
    }
}
