//! Room for labels beside the marks of a chart.

use std::ops::Range;

/// What is still free in a rectangle of pixels.
pub struct Room {
    whole: Block,
    taken: Vec<Block>,
}

/// From the left to the right, and from the top to the bottom.
type Block = [Range<i32>; 2];

const MARK: i32 = 5;

impl Room {
    pub fn new(whole: Block, marks: impl Iterator<Item = (i32, i32)>) -> Self {
        let taken = marks.map(|(x, y)| [x - MARK..x + MARK, y - MARK..y + MARK]);
        Self {
            whole,
            taken: taken.collect(),
        }
    }

    /// Takes the nearest room of this size beside a mark, and gives where it begins from there; none if
    /// what is free is so far away that it would not be seen to belong to the mark.
    #[expect(
        clippy::cast_possible_wrap,
        reason = "labels are a few hundred pixels wide"
    )]
    pub fn take(&mut self, mark: (i32, i32), size: (u32, u32)) -> Option<(i32, i32)> {
        let (width, height) = (size.0 as i32, size.1 as i32);
        if width == 0 {
            return None;
        }
        let steps = [0, -1, 1, -2, 2];
        let beside = steps.map(|step| -height / 2 + step * height * 2 / 3);
        let right = beside.map(|down| (MARK + 3, down));
        let left = beside.map(|down| (-MARK - 3 - width, down));
        let over = [-MARK - 2 - height, MARK + 2].map(|down| (-width / 2, down));
        let offset = right.into_iter().chain(over).chain(left).find(|offset| {
            let place = placed(mark, *offset, (width, height));
            holds(&self.whole, &place) && !self.taken.iter().any(|taken| overlap(taken, &place))
        })?;
        self.taken.push(placed(mark, offset, (width, height)));
        Some(offset)
    }
}

fn placed(mark: (i32, i32), offset: (i32, i32), size: (i32, i32)) -> Block {
    let (left, top) = (mark.0 + offset.0, mark.1 + offset.1);
    [left..left + size.0, top..top + size.1]
}

fn holds(whole: &Block, part: &Block) -> bool {
    whole
        .iter()
        .zip(part)
        .all(|(whole, part)| whole.start <= part.start && part.end <= whole.end)
}

fn overlap(a: &Block, b: &Block) -> bool {
    a.iter()
        .zip(b)
        .all(|(a, b)| a.start < b.end && b.start < a.end)
}
