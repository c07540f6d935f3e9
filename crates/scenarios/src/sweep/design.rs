//! Designs: which values of the factors are combined, as points of the unit cube or of a grid.
//!
//! Drawn coordinates are odd multiples of 2⁻⁵³, so that neither 0 nor 1, whose quantiles may be infinite, ever occurs.
//! Each factor has a stream of random numbers of its own: a further factor changes the values of no other. Random and
//! Sobol' points stay what they are when more are asked for.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sobol::Sobol;
use sobol::params::JoeKuoD6;
use toml::Value;

use super::factor::Factor;
use super::file::Design;

/// Bits of a drawn coordinate before its last one.
const BITS: u32 = 52;

/// Random bits that place a point in its stratum: few enough that a place times a number of strata stays exact.
const PLACE_BITS: u32 = 24;

impl Design {
    /// The points: for each a value of every factor.
    #[must_use]
    pub fn values(self, factors: &[Factor]) -> Vec<Vec<Value>> {
        let points = match self {
            Self::Grid {} => return grid(factors),
            Self::Random { points, seed } => random(points, factors.len(), seed),
            Self::LatinHypercube { points, seed } => latin_hypercube(points, factors.len(), seed),
            Self::Sobol { points, seed } => sobol(points, factors.len(), seed),
        };
        let quantiles = |point: Vec<f64>| -> Vec<Value> {
            point.iter().zip(factors).map(|(&share, factor)| factor.values.at(share)).collect()
        };
        points.into_iter().map(quantiles).collect()
    }
}

/// Every level with every other; the last factor changes from point to point.
fn grid(factors: &[Factor]) -> Vec<Vec<Value>> {
    let start = vec![Vec::new()];
    factors.iter().fold(start, |points, factor| {
        let extended = |point: &Vec<Value>| {
            let levels = factor.levels.iter().map(|level| [point.as_slice(), std::slice::from_ref(level)].concat());
            levels.collect::<Vec<_>>()
        };
        points.iter().flat_map(extended).collect()
    })
}

/// The random numbers of one factor.
fn stream(seed: u64, factor: usize) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(factor as u64);
    random
}

/// The coordinate of 64 bits: strictly between 0 and 1.
fn coordinate(bits: u64) -> f64 {
    ((bits >> (u64::BITS - BITS)) as f64 + 0.5) / (1_u64 << BITS) as f64
}

/// Points from coordinates that are listed factor by factor.
fn by_point(count: u64, by_factor: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..count as usize)
        .map(|point| by_factor.iter().filter_map(|coordinates| coordinates.get(point).copied()).collect())
        .collect()
}

/// Points drawn independently of each other.
fn random(count: u64, factors: usize, seed: u64) -> Vec<Vec<f64>> {
    let drawn = |factor| {
        let mut random = stream(seed, factor);
        (0..count).map(|_| coordinate(random.next_u64())).collect()
    };
    by_point(count, &(0..factors).map(drawn).collect::<Vec<_>>())
}

/// A Latin hypercube: each of `count` equal strata of each factor has one point.
///
/// M. D. McKay, R. J. Beckman, W. J. Conover, "A Comparison of Three Methods for Selecting Values of Input Variables in
/// the Analysis of Output from a Computer Code", Technometrics 21(2), 1979, doi:10.2307/1268522.
fn latin_hypercube(count: u64, factors: usize, seed: u64) -> Vec<Vec<f64>> {
    let drawn = |factor| {
        let mut random = stream(seed, factor);
        let mut order: Vec<(u64, u64)> = (0..count).map(|stratum| (random.next_u64(), stratum)).collect();
        order.sort_unstable();
        let placed = |(_, stratum): (u64, u64)| {
            let place = ((random.next_u64() >> (u64::BITS - PLACE_BITS)) as f64 + 0.5) / (1_u64 << PLACE_BITS) as f64;
            (stratum as f64 + place) / count as f64
        };
        order.into_iter().map(placed).collect()
    };
    by_point(count, &(0..factors).map(drawn).collect::<Vec<_>>())
}

/// The first points of the Sobol' sequence under a random digital shift.
///
/// S. Joe and F. Y. Kuo, "Constructing Sobol Sequences with Better Two-Dimensional Projections", SIAM Journal on
/// Scientific Computing 30(5), 2008, doi:10.1137/070709359. The shift is an exclusive or of the digits (P. L'Ecuyer and
/// C. Lemieux, "Recent Advances in Randomized Quasi-Monte Carlo Methods", 2002), not an addition modulo 1: both make each
/// point uniformly distributed, but only the former keeps the sequence as evenly balanced as it was.
fn sobol(count: u64, factors: usize, seed: u64) -> Vec<Vec<f64>> {
    let shifts: Vec<u64> = (0..factors).map(|factor| stream(seed, factor).next_u64()).collect();
    let shifted = |point: Vec<u64>| point.iter().zip(&shifts).map(|(bits, shift)| coordinate(bits ^ shift)).collect();
    sequence(factors).take(count as usize).map(shifted).collect()
}

/// The Sobol' sequence, its coordinates in units of 2⁻⁶⁴.
fn sequence(factors: usize) -> impl Iterator<Item = Vec<u64>> {
    Sobol::<u64>::new(factors, &JoeKuoD6::minimal())
}

#[cfg(test)]
#[path = "design_tests.rs"]
mod tests;
