//! The spatial arm against its own equations of motion, its controllers against their laws, and a gain study against numbers
//! of another program.

#![expect(clippy::expect_used, reason = "a test stops at the first surprise")]

mod allocation;
mod contact;
mod dynamics;
mod fixture;
mod joints;
mod loops;
mod stability;
mod study;
