//! Grains and containers against closed forms, published laws of granular flow, and bookkeeping that must be exact.

#![expect(clippy::expect_used, reason = "a test stops at the first surprise")]

mod bookkeeping;
mod contacts;
mod containers;
mod heap;
mod scaling;
mod scene;
mod settings;
mod silo;
mod spilling;
mod tilting;
