//! What a search is to do without, because no way of the tool was found there.

/// A place in phases at which no way of the tool was found, and how far that reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Barring {
    /// The tool does not come to its first hold.
    Start,
    /// The tool does not come away from its last hold.
    End,
    /// The tool does not change its hold after the phase of this index, because of its own shape: nowhere.
    Change(usize),
    /// The tool does not change its hold after the phase of this index, because of what is around: not near there.
    ChangeNearby(usize),
}

/// Cells around a place in which a change is given up at first; each further time for the same surfaces twice as many.
const FIRST_CELLS: i32 = 2;
/// Most cells around a place in which a change is given up.
const MOST_CELLS: i32 = 64;

/// All that was given up.
#[derive(Debug, Clone, Default)]
pub(super) struct Bars {
    starts: Vec<usize>,
    ends: Vec<usize>,
    /// Pairs of holds.
    changes: Vec<[usize; 2]>,
    /// Pairs of surfaces near a cell, within a number of cells.
    nearby: Vec<([usize; 2], [i32; 2], i32)>,
}

impl Bars {
    pub(super) fn bar_start(&mut self, hold: usize) {
        self.starts.push(hold);
    }

    pub(super) fn bar_end(&mut self, hold: usize) {
        self.ends.push(hold);
    }

    pub(super) fn bar_change(&mut self, holds: [usize; 2]) {
        self.changes.push(holds);
    }

    pub(super) fn bar_nearby(&mut self, surfaces: [usize; 2], cell: [i32; 2]) {
        let before = self.nearby.iter().filter(|(pair, ..)| *pair == surfaces).count();
        let cells = u32::try_from(before).ok().and_then(|count| FIRST_CELLS.checked_shl(count)).unwrap_or(MOST_CELLS);
        self.nearby.push((surfaces, cell, cells.clamp(FIRST_CELLS, MOST_CELLS)));
    }

    pub(super) fn allows_start(&self, hold: usize) -> bool {
        !self.starts.contains(&hold)
    }

    pub(super) fn allows_end(&self, hold: usize) -> bool {
        !self.ends.contains(&hold)
    }

    pub(super) fn allows_change(&self, holds: [usize; 2], surfaces: [usize; 2], cell: [i32; 2]) -> bool {
        let near = |(pair, center, cells): &([usize; 2], [i32; 2], i32)| {
            *pair == surfaces && (0..2).all(|axis| (cell[axis] - center[axis]).abs() <= *cells)
        };
        !self.changes.contains(&holds) && !self.nearby.iter().any(near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_given_up_for_its_holds_everywhere_or_for_its_surfaces_around_a_place() {
        let mut bars = Bars::default();
        bars.bar_change([3, 7]);
        assert!(!bars.allows_change([3, 7], [0, 1], [5, 5]) && bars.allows_change([7, 3], [1, 0], [5, 5]));
        bars.bar_nearby([0, 1], [10, 10]);
        assert!(!bars.allows_change([0, 8], [0, 1], [12, 8]) && bars.allows_change([0, 8], [0, 1], [13, 10]));
        // the second time twice as far
        bars.bar_nearby([0, 1], [13, 10]);
        assert!(!bars.allows_change([0, 8], [0, 1], [17, 10]) && bars.allows_change([0, 8], [0, 1], [18, 10]));
        (0..40).for_each(|_| bars.bar_nearby([0, 1], [0, 0]));
        assert!(bars.allows_change([0, 8], [0, 1], [MOST_CELLS + 1, 30]));
    }

    #[test]
    fn starts_and_ends_are_given_up_by_hold() {
        let mut bars = Bars::default();
        bars.bar_start(1);
        bars.bar_end(2);
        assert!(!bars.allows_start(1) && bars.allows_start(2) && bars.allows_end(1) && !bars.allows_end(2));
    }
}
