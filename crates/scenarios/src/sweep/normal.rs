//! Quantiles of the normal distribution.
//!
//! M. J. Wichura, "Algorithm AS 241: The Percentage Points of the Normal Distribution", Applied Statistics 37(3), 1988,
//! doi:10.2307/2347330, the variant of 16 digits. Logarithms come from one portable implementation, so that the same
//! share gives the same bits everywhere.

use nalgebra::ComplexField;

/// Quotient of two polynomials, lowest power first.
struct Rational {
    numerator: [f64; 8],
    denominator: [f64; 8],
}

/// For shares within 0.425 of one half.
const CENTRAL: Rational = Rational {
    numerator: [
        3.387_132_872_796_366_608,
        1.331_416_678_917_843_774_5e2,
        1.971_590_950_306_551_442_7e3,
        1.373_169_376_550_946_112_5e4,
        4.592_195_393_154_987_145_7e4,
        6.726_577_092_700_870_085_3e4,
        3.343_057_558_358_812_810_5e4,
        2.509_080_928_730_122_672_7e3,
    ],
    denominator: [
        1.0,
        4.231_333_070_160_091_125_2e1,
        6.871_870_074_920_579_083e2,
        5.394_196_021_424_751_107_7e3,
        2.121_379_430_158_659_586_7e4,
        3.930_789_580_009_271_061e4,
        2.872_908_573_572_194_267_4e4,
        5.226_495_278_852_854_561e3,
    ],
};

/// For the tails, down to shares of about 1e-11.
const TAIL: Rational = Rational {
    numerator: [
        1.423_437_110_749_683_577_34,
        4.630_337_846_156_545_295_9,
        5.769_497_221_460_691_405_5,
        3.647_848_324_763_204_605_04,
        1.270_458_252_452_368_382_58,
        2.417_807_251_774_506_117_7e-1,
        2.272_384_498_926_918_458_33e-2,
        7.745_450_142_783_414_076_4e-4,
    ],
    denominator: [
        1.0,
        2.053_191_626_637_758_821_87,
        1.676_384_830_183_803_849_4,
        6.897_673_349_851_000_045_5e-1,
        1.481_039_764_274_800_745_9e-1,
        1.519_866_656_361_645_719_66e-2,
        5.475_938_084_995_344_946e-4,
        1.050_750_071_644_416_843_24e-9,
    ],
};

/// For what lies beyond.
const FAR_TAIL: Rational = Rational {
    numerator: [
        6.657_904_643_501_103_777_2,
        5.463_784_911_164_114_369_9,
        1.784_826_539_917_291_335_8,
        2.965_605_718_285_048_912_3e-1,
        2.653_218_952_657_612_309_3e-2,
        1.242_660_947_388_078_438_6e-3,
        2.711_555_568_743_487_578_15e-5,
        2.010_334_399_292_288_132_65e-7,
    ],
    denominator: [
        1.0,
        5.998_322_065_558_879_376_9e-1,
        1.369_298_809_227_358_053_1e-1,
        1.487_536_129_085_061_485_25e-2,
        7.868_691_311_456_132_591e-4,
        1.846_318_317_510_054_681_8e-5,
        1.421_511_758_316_445_888_7e-7,
        2.044_263_103_389_939_785_64e-15,
    ],
};

impl Rational {
    fn at(&self, x: f64) -> f64 {
        let value = |coefficients: &[f64; 8]| coefficients.iter().rev().fold(0.0, |sum, next| sum * x + next);
        value(&self.numerator) / value(&self.denominator)
    }
}

/// The number below which a share of the standard normal distribution lies; infinite at 0 and 1.
pub fn normal_quantile(share: f64) -> f64 {
    let from_middle = share - 0.5;
    if from_middle.abs() <= 0.425 {
        return from_middle * CENTRAL.at(0.180_625 - from_middle * from_middle);
    }
    let tail = if from_middle < 0.0 { share } else { 1.0 - share };
    if tail <= 0.0 {
        return f64::INFINITY.copysign(from_middle);
    }
    let depth = (-ComplexField::ln(tail)).sqrt();
    let magnitude = if depth <= 5.0 { TAIL.at(depth - 1.6) } else { FAR_TAIL.at(depth - 5.0) };
    magnitude.copysign(from_middle)
}

/// The share of the standard normal distribution that lies below `value`: the quantile turned round by bisection.
pub fn normal_share(value: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    // ends when no number lies between the two
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return middle;
        }
        if normal_quantile(middle) < value { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The algorithm promises about one part in 1e16; the rest is rounding.
    const EXACT: f64 = 2e-15;

    #[test]
    fn quantiles_agree_with_published_values() {
        // Wichura 1988, table of tests, and the usual 97.5 % point
        let expect = [
            (0.25, -0.674_489_750_196_081_7),
            (0.001, -3.090_232_306_167_813_5),
            (1e-20, -9.262_340_089_798_408),
            (0.975, 1.959_963_984_540_054),
            (0.5, 0.0),
        ];
        for (share, quantile) in expect {
            let found = normal_quantile(share);
            assert!((found - quantile).abs() <= EXACT * f64::max(1.0, quantile.abs()), "{share}: {found}");
        }
        assert_eq!([normal_quantile(0.0), normal_quantile(1.0)], [f64::NEG_INFINITY, f64::INFINITY]);
    }

    #[test]
    fn shares_agree_with_the_series_of_the_error_function() {
        // Φ(x) = 1/2 + φ(x) Σ x^(2k+1) / (1·3·…·(2k+1)), Marsaglia 2004
        for value in [-4.0, -2.5, -1.0, -0.3, 0.0, 0.7, 1.96, 3.5] {
            let (mut term, mut sum, mut odd) = (value, value, 1.0);
            while (sum + term) != sum {
                odd += 2.0;
                term *= value * value / odd;
                sum += term;
            }
            let expected = 0.5 + sum * (-0.5 * value * value).exp() / (2.0 * std::f64::consts::PI).sqrt();
            assert!((normal_share(value) - expected).abs() < 1e-14, "{value}: {}", normal_share(value));
        }
        assert!(normal_share(f64::NEG_INFINITY) < 1e-300 && normal_share(f64::INFINITY) > 1.0 - 1e-15);
    }
}
