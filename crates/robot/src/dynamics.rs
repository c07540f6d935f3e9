//! The equations of motion M(q) q̈ + C(q, q̇) q̇ + g(q) = τ + Jᵀ F, each term by its recursive algorithm.

pub(crate) mod composite;
mod coriolis;
mod forward_dynamics;
mod inverse_dynamics;
mod mass_matrix;
pub(crate) mod scratch;

#[cfg(test)]
mod tests;
