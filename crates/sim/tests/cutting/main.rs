//! Foods cut by a knife in the hand of a simulated arm, against closed forms and books that must balance.

#![expect(clippy::expect_used, reason = "a test stops at the first surprise")]

mod books;
mod failures;
mod fixture;
mod forces;
mod limits;
mod quality;
mod steps;
mod thirds;
