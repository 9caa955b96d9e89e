//! Passes that solids share.

use piola_device::{Dialect, Pass, Use, local, own, through};

use super::numbers::{Recorded, one, take};

/// Velocities change by accelerations, which are a column of this name.
pub(crate) fn kick<const D: usize>(dialect: Dialect, acceleration: &'static str) -> Pass {
    let (reads, writes) = ([own("velocity", D), own(acceleration, D)], [own("velocity", D)]);
    local(dialect, "kick_velocities", &["duration"], &reads, &writes, |mut x| {
        let duration = one(&mut x);
        let (velocity, rate): (Recorded<D>, Recorded<D>) = (take(&mut x), take(&mut x));
        (velocity + rate * duration).iter().copied().collect()
    })
}

/// Numbers of some columns of a particle.
pub(crate) fn width(columns: &[(&'static str, usize)]) -> usize {
    columns.iter().map(|(_, width)| width).sum()
}

/// Rows of the particles on which something acts, of columns with these numbers a particle.
pub(crate) fn show(dialect: Dialect, columns: &[(&'static str, usize)]) -> Pass {
    let reads: Vec<Use> =
        columns.iter().map(|(column, width)| through("listed", column, *width)).collect();
    let width = width(columns);
    local(dialect, "show", &[], &reads, &[own("shown", width)], |x| x.to_vec())
}

/// Accelerations of the same, a column of this name, as something has acted on them.
pub(crate) fn give<const D: usize>(dialect: Dialect, acceleration: &'static str) -> Pass {
    let writes = [through("listed", acceleration, D)];
    local(dialect, "take", &[], &[own("given", D)], &writes, |x| x.to_vec())
}
