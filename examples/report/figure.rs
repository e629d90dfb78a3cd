//! Line and point charts, drawn as SVG.

use std::path::Path;

use plotters::backend::SVGBackend;
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::{Shift, cartesian::Cartesian2d};
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Circle, EmptyElement, PathElement, Text, TriangleMarker};
use plotters::series::{DashedLineSeries, LineSeries};
use plotters::style::{Color, IntoFont, RGBColor, WHITE};

use crate::axis::{Scale, short};
use crate::room::Room;

/// Panels side by side, with one legend for all of them.
pub struct Figure {
    pub title: String,
    /// What was measured, and where.
    pub subtitle: String,
    pub panels: Vec<Panel>,
}

pub struct Panel {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
}

#[derive(Clone, Debug)]
pub struct Axis {
    /// With the unit.
    pub label: String,
    pub is_log: bool,
}

impl Axis {
    pub fn linear(label: &str) -> Self {
        Self {
            label: label.into(),
            is_log: false,
        }
    }

    pub fn log(label: &str) -> Self {
        Self {
            label: label.into(),
            is_log: true,
        }
    }
}

/// Points of one kind.
#[derive(Clone, Debug)]
pub struct Series {
    pub name: String,
    pub look: Look,
    pub points: Vec<Point>,
}

#[derive(Clone, Debug)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    /// Where the true value is, as far as is known.
    pub range: Option<[f64; 2]>,
    /// What is written beside it.
    pub label: String,
}

impl Point {
    pub fn new(x: f64, y: f64) -> Self {
        Self {
            x,
            y,
            range: None,
            label: String::new(),
        }
    }

    pub fn within(self, range: [f64; 2]) -> Self {
        Self {
            range: Some(range),
            ..self
        }
    }

    pub fn labelled(self, label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            ..self
        }
    }
}

/// Colours that remain different to most eyes [Okabe & Ito 2008], and lines that differ in print.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    pub color: usize,
    pub line: Line,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    Solid,
    Dashed,
    /// Points alone.
    None,
}

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
type Outcome = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// Of a panel that has others beside it, and of one alone.
const PANEL: (u32, u32) = (540, 440);
const LONE_PANEL: (u32, u32) = (900, 620);
const LEGEND_WIDTH: u32 = 210;
const HEAD: u32 = 62;
const INK: RGBColor = RGBColor(40, 40, 40);
const FAINT: RGBColor = RGBColor(225, 225, 225);

impl Figure {
    /// Writes the figure to `path`, all of it or nothing.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let unfinished = path.with_extension("svg.part");
        self.draw(&unfinished)
            .map_err(|error| error.to_string())
            .and_then(|()| std::fs::rename(&unfinished, path).map_err(|error| error.to_string()))
            .map_err(|reason| format!("cannot write {}: {reason}", path.display()))
    }

    #[expect(
        clippy::cast_possible_wrap,
        reason = "figures are a few thousand pixels wide"
    )]
    fn draw(&self, path: &Path) -> Outcome {
        let count = self.panels.len();
        let (panel, columns) = if count == 1 {
            (LONE_PANEL, 1)
        } else {
            (PANEL, 2)
        };
        let rows = count.div_ceil(columns);
        let width = panel.0 * columns as u32 + LEGEND_WIDTH;
        let height = panel.1 * rows as u32 + HEAD;
        let whole = SVGBackend::new(path, (width, height)).into_drawing_area();
        whole.fill(&WHITE)?;
        let title = ("sans-serif", 20).into_font().color(&INK);
        whole.draw(&Text::new(self.title.clone(), (14, 10), title))?;
        let small = ("sans-serif", 13).into_font().color(&INK);
        whole.draw(&Text::new(self.subtitle.clone(), (14, 38), small))?;
        let (_, below) = whole.split_vertically(HEAD as i32);
        let (charts, legend) = below.split_horizontally((width - LEGEND_WIDTH) as i32);
        for (panel, area) in self.panels.iter().zip(charts.split_evenly((rows, columns))) {
            panel.draw(&area)?;
        }
        self.draw_legend(&legend)?;
        whole.present()
    }

    fn draw_legend(&self, area: &Area) -> Outcome {
        let mut drawn: Vec<(&str, Look)> = Vec::new();
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            let entry = (&*series.name, series.look);
            if !series.name.is_empty() && !drawn.contains(&entry) {
                drawn.push(entry);
            }
        }
        let font = ("sans-serif", 13).into_font().color(&INK);
        for ((name, look), row) in drawn.into_iter().zip(0..) {
            let y = 40 + 21 * row;
            let ends = [(6, y), (34, y)];
            let style = look.color().stroke_width(2);
            match look.line {
                Line::Solid => area.draw(&PathElement::new(ends, style))?,
                Line::Dashed => {
                    for dash in [[(6, y), (14, y)], [(26, y), (34, y)]] {
                        area.draw(&PathElement::new(dash, style))?;
                    }
                }
                Line::None => {}
            }
            draw_marker(
                look,
                (20, y),
                |circle| area.draw(&circle),
                |mark| area.draw(&mark),
            )?;
            area.draw(&Text::new(name.to_owned(), (42, y - 7), font.clone()))?;
        }
        Ok(())
    }
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
    fn draw(&self, area: &Area) -> Outcome {
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
            .caption(&self.title, ("sans-serif", 15).into_font().color(&INK))
            .x_label_area_size(44)
            .y_label_area_size(66)
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .x_labels(8)
            .y_labels(8)
            .x_label_formatter(&|x| short(*x))
            .y_label_formatter(&|y| short(*y))
            .axis_desc_style(("sans-serif", 14).into_font().color(&INK))
            .label_style(("sans-serif", 12).into_font().color(&INK))
            .bold_line_style(FAINT)
            .light_line_style(WHITE)
            .draw()?;
        for series in &self.series {
            series.draw(&mut chart, x, y)?;
        }
        self.draw_labels(&chart, x, y)
    }

    /// After all marks, to which labels leave room.
    fn draw_labels(&self, chart: &Chart, x: Scale, y: Scale) -> Outcome {
        let area = chart.plotting_area();
        let font = ("sans-serif", 12).into_font().color(&INK);
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
