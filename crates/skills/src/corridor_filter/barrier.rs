//! The Lyapunov function V^c of Eq. (31).

use crate::corridor::Bounds;

/// Evaluates V^c of Eq. (31): V^c = ½·log(W²/(4(x^H − x)(x − x^L))) + ½k_n·τ·z₂²; +∞ on the bounds and outside.
///
/// h̄ − z₁ = x^H − x^N, z₁ − h̲ = x^N − x^L and h̄ − h̲ = W: the barrier does not see x^u.
#[must_use]
pub fn lyapunov(bounds: &Bounds, position: f64, k_n: f64, duration_s: f64, z2: f64) -> f64 {
    let clearance = clearance(bounds, position);
    if clearance <= 0.0 || bounds.margin(position) <= 0.0 {
        return f64::INFINITY;
    }
    let width = bounds.width().position;
    0.5 * (width * width / (4.0 * clearance)).ln() + 0.5 * k_n * duration_s * z2 * z2
}

/// Evaluates D = (h̄ − z₁)(z₁ − h̲) = (x^H − x)(x − x^L), at most W²/4.
#[must_use]
pub fn clearance(bounds: &Bounds, position: f64) -> f64 {
    (bounds.upper.position - position) * (position - bounds.lower.position)
}
