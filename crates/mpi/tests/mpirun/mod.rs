//! Starting processes of MPI.

use std::process::Command;

/// As root, on fewer cores than there are ranks, which otherwise wait busily, and for two minutes at most.
const SETTINGS: [(&str, &str); 5] = [
    ("OMPI_ALLOW_RUN_AS_ROOT", "1"),
    ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"),
    ("OMPI_MCA_rmaps_base_oversubscribe", "1"),
    ("OMPI_MCA_mpi_yield_when_idle", "1"),
    ("MPIEXEC_TIMEOUT", "120"),
];

/// The command that starts processes; it needs to be told which.
pub fn mpirun() -> Command {
    let mut command = Command::new("mpirun");
    command.envs(SETTINGS);
    command
}
