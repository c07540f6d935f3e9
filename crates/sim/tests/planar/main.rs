//! The planar world against closed forms, an independent integrator, and the equations of the arm.

#![expect(clippy::expect_used, reason = "a test stops at the first surprise")]

mod allocation;
mod arm;
mod hold_renewal;
mod pushing;
mod quasi_static;
mod steering;
