//! Trials of a synthetic human: repeated until enough of them can be learned from.

use crate::pipeline::Progress;
use crate::tasks::StageError;

/// Trials that a human may spend on each demonstration wanted.
const TRIALS_PER_DEMONSTRATION: usize = 4;

/// One trial.
pub(crate) struct Trial<D> {
    /// Its number, from 1.
    pub number: usize,
    /// What was shown.
    pub demonstration: D,
    /// Why nothing can be learned from it.
    pub failure: Option<String>,
}

/// Lets a human try until `count` trials succeeded and hands on every one; too few successes are an error once patience ends.
///
/// `attempt` is given the index of the trial, from 0, and shows it.
pub(crate) fn run_trials<D>(
    count: usize,
    progress: Progress<'_>,
    attempt: &mut dyn FnMut(u64) -> Result<(D, Option<String>), StageError>,
    each: &mut dyn FnMut(Trial<D>) -> Result<(), StageError>,
) -> Result<(), StageError> {
    let (most, mut successes, mut reasons) = (count * TRIALS_PER_DEMONSTRATION, 0, Vec::new());
    for index in 0..most {
        if successes == count {
            break;
        }
        let (demonstration, failure) = attempt(index as u64)?;
        match &failure {
            Some(reason) => reasons.push(reason.clone()),
            None => successes += 1,
        }
        each(Trial { number: index + 1, demonstration, failure })?;
        progress("demonstrate", Some(successes as f64 / count as f64));
    }
    if successes == count {
        return Ok(());
    }
    Err(StageError::Infeasible(format!(
        "demonstrate: {successes} of {count} demonstrations could be learned from in {most} trials ({}); expected all; make \
         the task of the demonstration easier or the human's hand slower",
        reasons.join("; "),
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of the trials that were handed on while those in `failing` fail, and what came of them.
    fn tried(count: usize, failing: &[u64]) -> (Vec<usize>, Result<(), StageError>) {
        let mut numbers = Vec::new();
        let mut attempt = |index: u64| Ok(((), failing.contains(&index).then(|| format!("slip {index}"))));
        let result = run_trials(count, &|_, _| {}, &mut attempt, &mut |trial| {
            numbers.push(trial.number);
            Ok(())
        });
        (numbers, result)
    }

    #[test]
    fn trials_go_on_until_enough_succeeded() {
        assert_eq!(tried(2, &[1]), (vec![1, 2, 3], Ok(())));
    }

    #[test]
    fn patience_ends_with_every_reason_told() {
        let (numbers, result) = tried(1, &[0, 1, 2, 3]);
        assert_eq!(numbers, [1, 2, 3, 4]);
        let Err(StageError::Infeasible(told)) = result else { panic!("no refusal") };
        assert!(told.contains("0 of 1") && told.contains("slip 0; slip 1; slip 2; slip 3"), "{told}");
    }
}
