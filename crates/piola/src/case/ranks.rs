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
    let (executor, _) = begin(case, ranks.as_ref()).map_err(|_| Unserved::Refused)?;
    executor.serve(ranks, stop).map_err(|refusal| match refusal {
        RankRefusal::Ranks(lost) => Unserved::Lost(lost),
        _ => Unserved::Refused,
    })
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
    let identity = |(executor, _): &(Executor, Built)| {
        let own = resume::identity(case, executor.scheme.as_ref());
        own.into_iter().chain(env!("CARGO_PKG_VERSION").bytes()).collect::<Vec<u8>>()
    };
    let text = |problems: &Problems| problems.to_string();
    let own = built.as_ref().map(identity).map_err(text);
    let agreed = agree(ranks, own.as_deref().map_err(String::as_str));
    let built = built?;
    agreed.map_err(|message| refuse(Problem::new(case.scheme.place, message, "this run")))?;
    Ok(built)
}

/// Lets all ranks know whether each of them is ready, and for the same run.
///
/// # Errors
/// What the first says that is not, or who has another run.
fn agree(ranks: &dyn Ranks, own: Result<&[u8], &str>) -> Result<(), String> {
    // Of a report its sentence, and the place.
    let sentence = |why: &str| {
        let first = why.lines().next().unwrap_or_default().trim_start_matches("error: ");
        let place = why.lines().find_map(|line| line.trim_start().strip_prefix("--> "));
        place.map_or_else(|| first.to_owned(), |place| format!("{first} ({place})"))
    };
    let (is_ready, bytes) = match own {
        Ok(identity) => (1.0, identity.to_vec()),
        Err(why) => (0.0, sentence(why).into_bytes()),
    };
    let told: Vec<f64> =
        std::iter::once(is_ready).chain(bytes.into_iter().map(f64::from)).collect();
    let all = ranks.gather_to_all(&told).map_err(|lost| lost.to_string())?;
    let is_other = |other: &Vec<f64>| other.first() == Some(&1.0) && *other != all[0];
    for (rank, told) in all.iter().enumerate() {
        if told.first() != Some(&1.0) {
            let text: Vec<u8> = told.iter().skip(1).map(|byte| *byte as u8).collect();
            return Err(format!("rank {rank} cannot begin: {}", String::from_utf8_lossy(&text)));
        }
    }
    match all.iter().position(is_other) {
        None => Ok(()),
        Some(rank) => Err(format!(
            "rank {rank} has another case than rank 0, or another version of the program: give all of them the same"
        )),
    }
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
