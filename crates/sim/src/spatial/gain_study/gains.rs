//! The gains that the study compares, for the seven joints of a Panda.

use crate::controllers::ImpedanceConfig;

/// A set of gains of the impedance controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StudiedGains {
    /// The paper's: kₑ = 3, ξ = 10.
    Paper,
    /// kₑ = 10, ξ = 10.
    G1,
    /// kₑ = 10, ξ = 40 for the first four joints, 10, 10, 5 for the wrist: for motions without much contact.
    G2,
    /// kₑ = 20, ξ = 60, then 15, 15, 8: for cutting.
    G3,
    /// kₑ = 30, ξ = 100, then 25, 25, 12.
    G4,
}

impl StudiedGains {
    /// All of them, softest first.
    pub const ALL: [Self; 5] = [Self::Paper, Self::G1, Self::G2, Self::G3, Self::G4];

    /// Name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::G1 => "G1",
            Self::G2 => "G2",
            Self::G3 => "G3",
            Self::G4 => "G4",
        }
    }

    /// The gains themselves.
    #[must_use]
    pub fn config(self) -> ImpedanceConfig {
        let (error_gain_per_s, arm, wrist) = match self {
            Self::Paper => return ImpedanceConfig::paper(),
            Self::G1 => (10.0, 10.0, [10.0; 3]),
            Self::G2 => (10.0, 40.0, [10.0, 10.0, 5.0]),
            Self::G3 => (20.0, 60.0, [15.0, 15.0, 8.0]),
            Self::G4 => (30.0, 100.0, [25.0, 25.0, 12.0]),
        };
        let damping_nm_s_per_rad = [[arm; 4].as_slice(), &wrist].concat();
        ImpedanceConfig { error_gain_per_s, damping_nm_s_per_rad }
    }
}
