//! Exit codes, in one place.

/// How the program ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// All is well.
    Success,
    /// A check failed, or there was none.
    FailedCheck,
    /// The command line or the case is wrong. The argument parser uses the same code.
    BadCase,
    /// The simulation failed.
    FailedRun,
    /// A file or folder cannot be read or written.
    Io,
    /// Stopped by Ctrl-C or by a request to terminate.
    Interrupted,
}

impl Exit {
    /// All of them, as the help shows them.
    pub const ALL: [Self; 6] = [
        Self::Success,
        Self::FailedCheck,
        Self::BadCase,
        Self::FailedRun,
        Self::Io,
        Self::Interrupted,
    ];

    /// The number and its meaning.
    pub const fn describe(self) -> (u8, &'static str) {
        match self {
            Self::Success => (0, "success"),
            Self::FailedCheck => (1, "a check failed, or there was no check to evaluate"),
            Self::BadCase => (2, "bad command line, or bad case"),
            Self::FailedRun => (3, "the run failed; its last good state is on disk"),
            Self::Io => (4, "a file or folder cannot be read or written"),
            Self::Interrupted => {
                (130, "interrupted; the state after the last whole step is on disk")
            }
        }
    }

    /// The number.
    pub const fn code(self) -> u8 {
        self.describe().0
    }

    /// The table of the help.
    pub fn table() -> String {
        let lines = Self::ALL.map(|exit| {
            let (code, meaning) = exit.describe();
            format!("{code:>5}  {meaning}\n")
        });
        format!("Exit codes:\n{}", lines.concat())
    }
}

/// Why a command ends early: the code, and what stderr says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// How the program ends.
    pub exit: Exit,
    /// What the user reads.
    pub report: String,
}

impl Fault {
    /// A fault of one sentence.
    pub fn new(exit: Exit, message: impl std::fmt::Display) -> Self {
        Self { exit, report: format!("error: {message}\n") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_differ_and_are_in_the_help() {
        let mut codes = Exit::ALL.map(Exit::code).to_vec();
        codes.dedup();
        assert_eq!(codes, [0, 1, 2, 3, 4, 130]);
        for exit in Exit::ALL {
            assert!(Exit::table().contains(exit.describe().1));
        }
    }
}
