//! Runs of a case on several ranks.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use piola_ranks::{RankError, Ranks};
use thiserror::Error;

use super::assembly::Built;
use super::diagnostics::{Problem, Problems};
use super::model::Case;
use super::resume;
use super::session::executor;
use super::source::Place;
use crate::schemes::RankRefusal;
use crate::time::Executor;

/// Why a process takes no part in a run of several ranks, or no longer.
#[derive(Debug, Error)]
pub enum Unserved {
    /// The run does not begin. Rank 0 has the reason, of whichever rank it is.
    #[error("the run does not begin; the message of rank 0 says why")]
    Refused,
    /// It ends where a reserve of particles was to be extended.
    #[error(
        "the run ends, as its reserve of particles cannot be extended; the message of rank 0 says why"
    )]
    Ended,
    /// A rank is lost.
    #[error(transparent)]
    Lost(#[from] RankError),
}

/// Takes part in a run of which another process is rank 0 and has the [session](super::Session::on_ranks), until that ends
/// it, which it does soon after `stop` is set.
///
/// # Errors
/// The run cannot begin, or a rank is lost.
pub fn serve(case: &Case, ranks: Arc<dyn Ranks>, stop: Arc<AtomicBool>) -> Result<(), Unserved> {
    let (mut case, mut has_begun) = (case.clone(), false);
    loop {
        let refused = || if has_begun { Unserved::Ended } else { Unserved::Refused };
        let (executor, _) = begin(&case, ranks.as_ref()).map_err(|_| refused())?;
        let served = executor.serve(ranks.clone(), stop.clone());
        let more = served.map_err(|refusal| match refusal {
            RankRefusal::Ranks(lost) => Unserved::Lost(lost),
            _ => refused(),
        })?;
        let Some(more) = more else { return Ok(()) };
        (case.more_in_reserve, has_begun) = (more, true);
    }
}

/// Tells the other ranks that this one cannot begin, and why. It takes the place of [`serve`], or of
/// [`Session::on_ranks`](super::Session::on_ranks).
pub fn decline(ranks: &dyn Ranks, why: &str) {
    // Whoever is lost has not begun either.
    drop(agree(ranks, Err(why)));
}

/// Builds a run on all ranks, if they have the same case and can share it.
pub(super) fn begin(case: &Case, ranks: &dyn Ranks) -> Result<(Executor, Built), Problems> {
    let refuse = |problem| case.refuse(vec![problem]);
    let built = alone(case).map_err(refuse).and_then(|()| executor(case));
    let own = match &built {
        Ok((executor, _)) => Ok(resume::identity(case, executor.scheme.as_ref())),
        Err(problems) => Err(problems.to_string()),
    };
    let ready = own.as_ref().map(|case| Ready { version: VERSION, case: &case[..] });
    let agreed = agree(ranks, ready.map_err(String::as_str));
    let built = built?;
    agreed.map_err(|message| refuse(Problem::new(case.scheme.place, message, "this run")))?;
    Ok(built)
}

/// The version of the program.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What a rank is ready to run.
#[derive(Clone, Copy)]
struct Ready<'a> {
    /// The version of its program.
    version: &'a str,
    /// What tells its case from others.
    case: &'a [u8],
}

/// Lets all ranks know whether each of them is ready, and for the same run.
///
/// # Errors
/// What the first says that is not, or who has another version or another case.
fn agree(ranks: &dyn Ranks, own: Result<Ready, &str>) -> Result<(), String> {
    // Of a report its sentence, and the place.
    let sentence = |why: &str| {
        let first = why.lines().next().unwrap_or_default().trim_start_matches("error: ");
        let place = why.lines().find_map(|line| line.trim_start().strip_prefix("--> "));
        place.map_or_else(|| first.to_owned(), |place| format!("{first} ({place})"))
    };
    // Behind whether it is ready the length of the first of two texts.
    let (is_ready, [first, second]) = match own {
        Ok(Ready { version, case }) => (1.0, [version.as_bytes().to_vec(), case.to_vec()]),
        Err(why) => (0.0, [sentence(why).into_bytes(), Vec::new()]),
    };
    let head = [is_ready, first.len() as f64].into_iter();
    let told: Vec<f64> = head.chain(first.into_iter().chain(second).map(f64::from)).collect();
    let all = ranks.gather_to_all(&told).map_err(|lost| lost.to_string())?;
    let bytes = |numbers: &[f64]| numbers.iter().map(|byte| *byte as u8).collect::<Vec<u8>>();
    let said = |told: &Vec<f64>| match told.as_slice() {
        [is_ready, length, rest @ ..] => {
            let (first, second) = rest.split_at((*length as usize).min(rest.len()));
            let first = String::from_utf8_lossy(&bytes(first)).into_owned();
            (*is_ready == 1.0, first, bytes(second))
        }
        _ => (false, "it says nothing".to_owned(), Vec::new()),
    };
    let all: Vec<(bool, String, Vec<u8>)> = all.iter().map(said).collect();
    for (rank, (is_ready, why, _)) in all.iter().enumerate() {
        if !is_ready {
            return Err(format!("rank {rank} cannot begin: {why}"));
        }
    }
    let Some((_, expected, case)) = all.first() else { return Ok(()) };
    for (rank, (_, version, own)) in all.iter().enumerate() {
        if version != expected {
            return Err(format!(
                "rank {rank} is version {version} of the program, and rank 0 is version {expected}: start the same \
                 program on all of them"
            ));
        }
        if own != case {
            return Err(format!(
                "rank {rank} has another case than rank 0: give all of them the same"
            ));
        }
    }
    Ok(())
}

/// Lets a run take its steps on several ranks, of which this process is number 0 and all have begun.
pub(super) fn lead(
    executor: &mut Executor,
    case: &Case,
    ranks: Arc<dyn Ranks>,
) -> Result<(), Problems> {
    let refuse = |refusal| case.refuse(vec![refused(case.scheme.place, &refusal)]);
    executor.lead(ranks).map_err(refuse)
}

/// Lets a run take its steps on several ranks, which are threads of this process, if the case asks for that.
pub(super) fn use_threads(executor: &mut Executor, case: &Case) -> Result<(), Problem> {
    let Some(ranks) = &case.ranks else { return Ok(()) };
    no_device(case, ranks.place)?;
    let count = usize::try_from(**ranks).unwrap_or(usize::MAX);
    executor.use_ranks(count).map_err(|refusal| refused(ranks.place, &refusal))
}

/// Whether a case asks neither for ranks that are threads nor for a device, beside ranks that are processes.
fn alone(case: &Case) -> Result<(), Problem> {
    if let Some(threads) = &case.ranks {
        let message = "the ranks are processes of MPI: leave out `--ranks` and `compute.ranks`";
        return Err(Problem::new(threads.place, message.to_owned(), "beside MPI"));
    }
    no_device(case, case.scheme.place)
}

/// Whether there is no device beside ranks.
fn no_device(case: &Case, place: Place) -> Result<(), Problem> {
    let message = "a run has either several ranks or a device: leave out one of them";
    match &case.device {
        Some(_) => Err(Problem::new(place, message.to_owned(), "beside a device")),
        None => Ok(()),
    }
}

/// Why a case does not run on several ranks.
fn refused(place: Place, refusal: &RankRefusal) -> Problem {
    let label = match refusal {
        RankRefusal::TooMany { .. } => "too many",
        _ => "this case does not run on several ranks",
    };
    Problem::new(place, refusal.to_string(), label)
}

#[cfg(test)]
mod tests {
    use super::*;
    use piola_ranks::Threads;

    /// What each rank is told, of ranks that have this.
    fn told(all: &[Result<Ready, &str>]) -> Vec<Result<(), String>> {
        std::thread::scope(|scope| {
            let ranks = Threads::group(all.len()).into_iter().zip(all);
            let ranks: Vec<_> =
                ranks.map(|(rank, own)| scope.spawn(move || agree(&rank, *own))).collect();
            ranks.into_iter().map(|rank| rank.join().unwrap()).collect()
        })
    }

    #[test]
    fn ranks_begin_with_the_same_program_and_the_same_case() {
        let ready = |version, case| Ok(Ready { version, case });
        let same = ready("1.2.0", b"plate");
        let unreadable = Err("error: no such file\n   --> plate.toml:3:4\n");
        for (others, expected) in [
            ([same, same], Ok(())),
            (
                [same, ready("1.10.0", b"plate")],
                Err(
                    "rank 2 is version 1.10.0 of the program, and rank 0 is version 1.2.0: start the same program on all \
                     of them",
                ),
            ),
            // What is another case for one version may not be one for another.
            (
                [same, ready("1.2", b".0plate")],
                Err(
                    "rank 2 is version 1.2 of the program, and rank 0 is version 1.2.0: start the same program on all of \
                     them",
                ),
            ),
            (
                [ready("1.2.0", b"plat"), same],
                Err("rank 1 has another case than rank 0: give all of them the same"),
            ),
            (
                [ready("2.0.0", b"other"), unreadable],
                Err("rank 2 cannot begin: no such file (plate.toml:3:4)"),
            ),
        ] {
            let expected = expected.map_err(str::to_owned);
            assert_eq!(told(&[same, others[0], others[1]]), vec![expected; 3]);
        }
    }
}
