//! Figures as SVG.

use std::path::Path;

use plotters::backend::SVGBackend;
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::{Shift, cartesian::Cartesian2d};
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Circle, EmptyElement, PathElement, Text, TriangleMarker};
use plotters::series::{DashedLineSeries, LineSeries};
use plotters::style::{Color, IntoFont, RGBColor, WHITE};

use super::{Figure, Line, Look, Panel, Point, Series};
use crate::axis::Scale;
use crate::room::Room;

const COLORS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
    RGBColor(130, 130, 130),
];

impl Look {
    fn color(self) -> RGBColor {
        COLORS[self.color % COLORS.len()]
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Scale, Scale>>;
type Fault = DrawingAreaErrorKind<std::io::Error>;
type Outcome = Result<(), Fault>;

const WIDTH: u32 = 800;
/// Of a panel that is as wide as the figure, of one that has another beside it, and of one alone.
const WIDE: u32 = 350;
const NARROW: u32 = 330;
const LONE: u32 = 520;
/// Right of a wide panel, for the names of its series.
const NAMES: u32 = 178;
const HEAD: u32 = 62;
const LEGEND: u32 = 24;
const INK: RGBColor = RGBColor(40, 40, 40);
const FAINT: RGBColor = RGBColor(225, 225, 225);

/// How a figure says which series is which.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Naming {
    /// At the end of each curve.
    Beside,
    /// In a row above, for points that no curve joins.
    Legend,
    /// By the labels of their points.
    Points,
}

impl Figure {
    #[expect(
        clippy::cast_possible_wrap,
        reason = "figures are a few thousand pixels wide"
    )]
    pub(super) fn draw(&self, path: &Path) -> Outcome {
        let naming = self.naming();
        let (height, columns) = match (naming, self.panels.len()) {
            (Naming::Beside, _) => (WIDE, 1),
            (_, 1) => (LONE, 1),
            _ => (NARROW, 2),
        };
        let head = HEAD + if naming == Naming::Legend { LEGEND } else { 0 };
        let rows = self.panels.len().div_ceil(columns);
        let size = (WIDTH, head + height * rows as u32);
        let whole = SVGBackend::new(path, size).into_drawing_area();
        whole.fill(&WHITE)?;
        let title = ("sans-serif", 20).into_font().color(&INK);
        whole.draw(&Text::new(self.title.clone(), (14, 10), title))?;
        let small = ("sans-serif", 13).into_font().color(&INK);
        whole.draw(&Text::new(self.subtitle.clone(), (14, 38), small))?;
        if naming == Naming::Legend {
            self.draw_legend(&whole)?;
        }
        let (_, below) = whole.split_vertically(head as i32);
        for (panel, area) in self.panels.iter().zip(below.split_evenly((rows, columns))) {
            if naming == Naming::Beside {
                let (chart, _) = area.split_horizontally((WIDTH - NAMES) as i32);
                let ends = panel.draw(&chart)?;
                draw_names(&whole, ends)?;
            } else {
                panel.draw(&area)?;
            }
        }
        whole.present()
    }

    fn naming(&self) -> Naming {
        let series = || self.panels.iter().flat_map(|panel| &panel.series);
        let names_itself = |series: &Series| {
            let mut points = series.points.iter();
            series.name.is_empty() || points.all(|point| point.label == series.name)
        };
        if series().all(names_itself) {
            Naming::Points
        } else if series().all(|series| series.look.line == Line::None) {
            Naming::Legend
        } else {
            Naming::Beside
        }
    }

    #[expect(
        clippy::cast_possible_wrap,
        reason = "figures are a few hundred pixels wide"
    )]
    fn draw_legend(&self, area: &Area) -> Outcome {
        let mut drawn: Vec<(&str, Look)> = Vec::new();
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            let entry = (&*series.name, series.look);
            if !series.name.is_empty() && !drawn.contains(&entry) {
                drawn.push(entry);
            }
        }
        let font = ("sans-serif", 14).into_font().color(&INK);
        let mut x = 20;
        for (name, look) in drawn {
            draw_marker(
                look,
                (x, HEAD as i32 + 8),
                |circle| area.draw(&circle),
                |mark| area.draw(&mark),
            )?;
            area.draw(&Text::new(
                name.to_owned(),
                (x + 10, HEAD as i32),
                font.clone(),
            ))?;
            x += 34 + area.estimate_text_size(name, &font)?.0 as i32;
        }
        Ok(())
    }
}

/// Where a series ends, and the right edge of its panel.
struct End<'a> {
    name: &'a str,
    look: Look,
    mark: (i32, i32),
    edge: i32,
}

/// Writes the name of each series to the right of its end, one below the other.
fn draw_names(whole: &Area, mut ends: Vec<End>) -> Outcome {
    const LINE: i32 = 17;
    ends.sort_by_key(|end| (end.mark.1, end.mark.0));
    let heights: Vec<i32> = ends.iter().map(|end| end.mark.1).collect();
    for (end, y) in ends.iter().zip(spread(&heights, LINE)) {
        let color = end.look.color();
        let start = end.edge + 16;
        let leader = vec![end.mark, (end.edge + 4, y), (start, y)];
        whole.draw(&PathElement::new(leader, color.mix(0.5).stroke_width(1)))?;
        let font = ("sans-serif", 14).into_font().color(&color);
        whole.draw(&Text::new(end.name.to_owned(), (start + 3, y - 8), font))?;
    }
    Ok(())
}

/// Numbers as near the rising `heights` as they can be `apart`.
fn spread(heights: &[i32], apart: i32) -> Vec<i32> {
    // Groups of neighbours that touch, each around its mean: the sum of where its first would be, and its length.
    let mut groups: Vec<(i32, i32)> = Vec::new();
    for height in heights {
        groups.push((*height, 1));
        while let [.., (a, m), (b, n)] = groups[..] {
            if a / m + m * apart <= b / n {
                break;
            }
            groups.pop();
            groups.pop();
            groups.push((a + b - n * m * apart, m + n));
        }
    }
    let places = groups.into_iter();
    places
        .flat_map(|(sum, count)| (0..count).map(move |i| sum / count + i * apart))
        .collect()
}

/// Circles on solid lines and alone, triangles on dashed ones.
fn draw_marker<C>(
    look: Look,
    at: C,
    circle: impl FnOnce(Circle<C, i32>) -> Outcome,
    triangle: impl FnOnce(TriangleMarker<C, i32>) -> Outcome,
) -> Outcome {
    let filled = look.color().filled();
    if look.line == Line::Dashed {
        triangle(TriangleMarker::new(at, 5, filled))
    } else {
        circle(Circle::new(at, 4, filled))
    }
}

impl Panel {
    /// Draws it, and gives the end of each series that has a name.
    fn draw(&self, area: &Area) -> Result<Vec<End<'_>>, Fault> {
        let points = || self.series.iter().flat_map(|series| &series.points);
        let x = Scale::around(points().map(|point| point.x), self.x.is_log);
        let ends = points().flat_map(|point| {
            [point.y]
                .into_iter()
                .chain(point.range.into_iter().flatten())
        });
        let y = Scale::around(ends, self.y.is_log);
        let mut chart = ChartBuilder::on(area)
            .margin(12)
            .caption(&self.title, ("sans-serif", 16).into_font().color(&INK))
            .x_label_area_size(44)
            .y_label_area_size(66)
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .x_labels(8)
            .y_labels(8)
            .x_label_formatter(&|number| x.tick(*number))
            .y_label_formatter(&|number| y.tick(*number))
            .axis_desc_style(("sans-serif", 14).into_font().color(&INK))
            .label_style(("sans-serif", 13).into_font().color(&INK))
            .bold_line_style(FAINT)
            .light_line_style(WHITE)
            .draw()?;
        for series in &self.series {
            series.draw(&mut chart, x, y)?;
        }
        self.draw_labels(&chart, x, y)?;
        let plot = chart.plotting_area();
        let edge = plot.get_pixel_range().0.end;
        let ends = self.series.iter().filter_map(|series| {
            let shown = |point: &&Point| x.has(point.x) && y.has(point.y);
            let shown = series.points.iter().filter(shown);
            let last = shown.max_by(|a, b| a.x.total_cmp(&b.x))?;
            Some(End {
                name: &series.name,
                look: series.look,
                mark: plot.map_coordinate(&(last.x, last.y)),
                edge,
            })
        });
        Ok(ends.filter(|end| !end.name.is_empty()).collect())
    }

    /// After all marks, to which labels leave room.
    fn draw_labels(&self, chart: &Chart, x: Scale, y: Scale) -> Outcome {
        let area = chart.plotting_area();
        let font = ("sans-serif", 13).into_font().color(&INK);
        let points = self.series.iter().flat_map(|series| &series.points);
        let shown = points.filter(|point| x.has(point.x) && y.has(point.y));
        let shown: Vec<_> = shown
            .map(|point| (point, area.map_coordinate(&(point.x, point.y))))
            .collect();
        let (columns, rows) = area.get_pixel_range();
        let mut room = Room::new([columns, rows], shown.iter().map(|(_, mark)| *mark));
        for (point, mark) in shown {
            let size = area.estimate_text_size(&point.label, &font)?;
            if let Some(offset) = room.take(mark, size) {
                let at = EmptyElement::at((point.x, point.y));
                area.draw(&(at + Text::new(point.label.clone(), offset, font.clone())))?;
            }
        }
        Ok(())
    }
}

impl Series {
    fn draw(&self, chart: &mut Chart, x: Scale, y: Scale) -> Outcome {
        let shown: Vec<&Point> = self
            .points
            .iter()
            .filter(|point| x.has(point.x) && y.has(point.y))
            .collect();
        let line = || shown.iter().map(|point| (point.x, point.y));
        let style = self.look.color().stroke_width(2);
        match self.look.line {
            Line::Solid => {
                chart.draw_series(LineSeries::new(line(), style))?;
            }
            Line::Dashed => {
                chart.draw_series(DashedLineSeries::new(line(), 8, 5, style))?;
            }
            Line::None => {}
        }
        for point in &shown {
            let at = (point.x, point.y);
            if let Some(range) = point.range {
                let ends = range.map(|end| (point.x, y.nearest(end)));
                let bar = PathElement::new(ends, self.look.color().stroke_width(1));
                chart.draw_series([bar])?;
            }
            let area = chart.plotting_area();
            draw_marker(
                self.look,
                at,
                |circle| area.draw(&circle),
                |mark| area.draw(&mark),
            )?;
        }
        Ok(())
    }
}
