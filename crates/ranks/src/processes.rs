//! What processes are told by what has started them.

use std::env;

/// How many there are, by Open MPI, and by all that speak PMI: MPICH, Intel, Slurm.
const SIZES: [&str; 2] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"];

/// How many there are in a step of Slurm. A shell that it opens in an allocation is a step of one, too.
const TASKS: &str = "SLURM_STEP_NUM_TASKS";

/// The number of a process, from 0, by all that speak PMIx.
const RANK: &str = "PMIX_RANK";

/// How many processes, at least, something like `mpirun` has started together, of which this is one; `None` if it was
/// started alone.
pub fn processes() -> Option<usize> {
    told(|name| env::var(name).ok()?.parse().ok())
}

/// What the variables say.
fn told(number: impl Fn(&str) -> Option<usize>) -> Option<usize> {
    // `mpirun` in a step of Slurm knows better than that does.
    if let Some(size) = SIZES.into_iter().filter_map(&number).max() {
        return Some(size);
    }
    let (tasks, rank) = (number(TASKS), number(RANK));
    let least = rank.map_or(0, |rank| rank.saturating_add(1)).max(tasks.unwrap_or(0));
    let is_told = least > 1 || rank.is_some() && tasks.is_none();
    is_told.then_some(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What starts processes, what it tells one of them, and how many there are by that.
    type Start = (&'static str, &'static [(&'static str, &'static str)], Option<usize>);

    #[test]
    fn what_starts_processes_tells_how_many_they_are() {
        let cases: [Start; 12] = [
            ("by hand", &[], None),
            ("mpirun of Open MPI", &[(SIZES[0], "4"), (RANK, "0")], Some(4)),
            ("mpirun of one process", &[(SIZES[0], "1"), (RANK, "0")], Some(1)),
            ("mpiexec of MPICH", &[(SIZES[1], "3")], Some(3)),
            ("one PMI in another", &[(SIZES[0], "1"), (SIZES[1], "4")], Some(4)),
            ("srun --mpi=pmix", &[(TASKS, "4"), (RANK, "0")], Some(4)),
            ("srun --mpi=none", &[(TASKS, "4")], Some(4)),
            ("a shell of salloc", &[(TASKS, "1")], None),
            ("a shell of salloc, with PMIx", &[(TASKS, "1"), (RANK, "0")], None),
            ("mpirun in a shell of salloc", &[(TASKS, "1"), (SIZES[0], "2")], Some(2)),
            ("the first of those that only PMIx knows", &[(RANK, "0")], Some(1)),
            ("the third of them", &[(RANK, "2")], Some(3)),
        ];
        for (what, variables, expected) in cases {
            let number = |name: &str| {
                let value = variables.iter().find(|(variable, _)| *variable == name)?.1;
                value.parse().ok()
            };
            assert_eq!(told(number), expected, "{what}");
        }
    }
}
