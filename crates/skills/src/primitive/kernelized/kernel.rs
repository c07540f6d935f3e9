//! The Gaussian kernel over progress, extended by its derivatives so that velocities can be given and asked for.
//!
//! Departs from the article, which differences the kernel over a small step: the derivatives here are analytic.

/// Value or rate of one coordinate at one progress: what a row of the extended kernel matrix stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Row {
    pub(super) progress: f64,
    /// Rate per length scale l of progress, which has the unit and size of the value, instead of the value.
    pub(super) rate: bool,
}

impl Row {
    pub(super) fn value(progress: f64) -> Self {
        Self { progress, rate: false }
    }

    pub(super) fn rate(progress: f64) -> Self {
        Self { progress, rate: true }
    }
}

/// k(u, u') = exp(−z²/2) with z = (u − u')/l, u being progress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Kernel {
    length_scale: f64,
}

/// One column of the extended kernel with its first two derivatives by progress: for a given value and a given rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Columns {
    pub(super) value: [f64; 3],
    pub(super) rate: [f64; 3],
}

impl Kernel {
    pub(super) fn new(length_scale: f64) -> Self {
        Self { length_scale }
    }

    pub(super) fn length_scale(self) -> f64 {
        self.length_scale
    }

    /// Evaluates the covariance of two rows.
    pub(super) fn between(self, row: Row, other: Row) -> f64 {
        let z = (row.progress - other.progress) / self.length_scale;
        let k = (-0.5 * z * z).exp();
        match (row.rate, other.rate) {
            (false, false) => k,
            (false, true) => z * k,
            (true, false) => -z * k,
            (true, true) => (1.0 - z * z) * k,
        }
    }

    /// Evaluates the columns of the point `at` for the value at `progress` and its derivatives by progress.
    pub(super) fn columns(self, progress: f64, at: f64) -> Columns {
        let l = self.length_scale;
        let z = (progress - at) / l;
        let k = (-0.5 * z * z).exp();
        let (first, second) = (k / l, k / (l * l));
        Columns {
            value: [k, -z * first, (z * z - 1.0) * second],
            rate: [z * k, (1.0 - z * z) * first, z * (z * z - 3.0) * second],
        }
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    /// Error of a central difference over 1e-4 of a kernel of length 0.2.
    const DIFFERENCE: f64 = 1e-5;

    #[test]
    fn derivatives_are_those_of_the_kernel() {
        let kernel = Kernel::new(0.2);
        let h = 1e-4;
        for (u, at) in [(0.3, 0.5), (0.5, 0.5), (0.9, 0.45)] {
            let [before, here, after] = [u - h, u, u + h].map(|u| kernel.columns(u, at));
            for part in [|columns: Columns| columns.value, |columns: Columns| columns.rate] {
                for order in 0..2 {
                    let slope = (part(after)[order] - part(before)[order]) / (2.0 * h);
                    assert_relative_eq!(part(here)[order + 1], slope, epsilon = DIFFERENCE * 0.2f64.powi(-3));
                }
            }
            // a rate column is the derivative of the value column by the other point, per length scale
            let by_other = (kernel.columns(u, at + h).value[0] - kernel.columns(u, at - h).value[0]) / (2.0 * h);
            assert_relative_eq!(here.rate[0], 0.2 * by_other, epsilon = DIFFERENCE);
        }
    }

    #[test]
    fn rows_are_the_columns_at_their_points() {
        let kernel = Kernel::new(0.3);
        let columns = kernel.columns(0.2, 0.6);
        assert_relative_eq!(kernel.between(Row::value(0.2), Row::value(0.6)), columns.value[0]);
        assert_relative_eq!(kernel.between(Row::value(0.2), Row::rate(0.6)), columns.rate[0]);
        assert_relative_eq!(kernel.between(Row::rate(0.2), Row::value(0.6)), 0.3 * columns.value[1]);
        assert_relative_eq!(kernel.between(Row::rate(0.2), Row::rate(0.6)), 0.3 * columns.rate[1]);
    }
}
